"""A set-point with bounded speed, acceleration and braking, so that a joint can follow it."""

from math import inf, sqrt

LATE_BRAKING = 1.8
"""Most that a set-point brakes with when it is late, in units of the braking that it plans with.

Plans use half of the effort that gravity leaves a joint; this uses nine tenths."""
LANDING_SLACK = 1.0001
"""Rounding allowance on the speed in the last period."""


class Setpoint:
    """Desired position and velocity of a joint; rad or m, and per second.

    Call `approach` once in each control period. Between two calls the set-point moves with
    constant acceleration.

    Attributes:
        position: position at the end of the last period.
        velocity: velocity at the end of the last period.
    """

    __slots__ = ("position", "velocity")

    def __init__(self, position: float, velocity: float = 0.0) -> None:
        self.position = position
        self.velocity = velocity

    def approach(
        self,
        target: float,
        target_velocity: float,
        speed: float,
        acceleration: float,
        braking: float,
        period_s: float,
    ) -> None:
        """Move towards a target as fast as the bounds allow, without overshoot.

        Args:
            target: position of the target at the end of this period; may be infinite.
            target_velocity: velocity of the target; 0 for a fixed target.
            speed: highest speed, at least 0.
            acceleration: acceleration that the joint can reach now.
            braking: deceleration that stops are planned with, above 0.
            period_s: length of the period.
        """
        # Comparisons instead of min, max and abs: this runs for every joint in every tick.
        if target_velocity > speed:
            target_velocity = speed
        elif target_velocity < -speed:
            target_velocity = -speed
        # In the frame of the target, which moves with constant velocity, the target is at rest.
        distance = target - target_velocity * period_s - self.position
        velocity = self.velocity - target_velocity
        change = acceleration * period_s
        brake = braking * period_s
        # A moving target can be followed with the present acceleration, so it may be met with it.
        landing = change if target_velocity else brake
        reach = speed * period_s * LANDING_SLACK
        if -landing <= velocity <= landing and -reach <= target - self.position <= reach:
            miss = distance - 0.5 * velocity * period_s
            within = 0.25 * landing * period_s
            if -within <= miss <= within:
                self.position = target
                self.velocity = target_velocity
                return
        sign = 1.0
        if distance < 0.0 or (distance == 0.0 and velocity > 0.0):
            sign, distance, velocity = -1.0, -distance, -velocity
        # The highest final speed of this period from which `braking` still stops at the target:
        # v'^2 <= 2 braking (distance - (v + v') period / 2), solved for v'.
        root = brake * (0.25 * brake - velocity) + 2.0 * braking * distance
        fastest = sqrt(root) - 0.5 * brake if root > 0.0 else -inf
        cruise = speed - sign * target_velocity
        hardest = change
        if fastest > cruise:
            fastest = cruise
        elif LATE_BRAKING * brake > change:
            # What the stop was planned with may have become too little.
            hardest = LATE_BRAKING * brake
        if fastest > velocity + change:
            fastest = velocity + change
        elif fastest < velocity - hardest:
            fastest = velocity - hardest
        end = target_velocity + sign * fastest
        self.position += 0.5 * period_s * (self.velocity + end)
        self.velocity = end

    def stopping_point(self, braking: float) -> float:
        """Return where the set-point stops if it brakes from now on."""
        return self.position + 0.5 * self.velocity * abs(self.velocity) / braking
