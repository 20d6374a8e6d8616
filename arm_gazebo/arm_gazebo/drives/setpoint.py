"""A set-point that moves as a joint can: bounded in speed, acceleration and braking."""

from math import inf, sqrt

LANDING_SLACK = 1.0001
"""Rounding allowance on the speed of the last stretch."""


class Setpoint:
    """Position and velocity that a joint is asked to have; rad or m, and per second.

    One call of `approach` for each control period. Between two calls the set-point moves with
    constant acceleration.

    Attributes:
        position: at the end of the last period.
        velocity: at the end of the last period.
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
        """Move towards a target, as fast as the bounds allow, without ever passing it.

        Args:
            target: where the target is at the end of this period; may be infinite.
            target_velocity: how fast the target moves; 0 for a target that stands.
            speed: highest speed, at least 0.
            acceleration: what the joint can do now, at least `braking`.
            braking: what it can do wherever it stops, above 0; stops are planned with it.
            period_s: length of the period.
        """
        # Comparisons instead of min, max and abs: this runs for every joint in every tick.
        if target_velocity > speed:
            target_velocity = speed
        elif target_velocity < -speed:
            target_velocity = -speed
        # Seen from the target, which moves with constant velocity, everything is a way to rest.
        way = target - target_velocity * period_s - self.position
        velocity = self.velocity - target_velocity
        change = acceleration * period_s
        brake = braking * period_s
        # A moving target is one that can be followed: it asks no more than the joint can now.
        landing = change if target_velocity else brake
        reach = speed * period_s * LANDING_SLACK
        if -landing <= velocity <= landing and -reach <= target - self.position <= reach:
            miss = way - 0.5 * velocity * period_s
            within = 0.25 * landing * period_s
            if -within <= miss <= within:
                self.position = target
                self.velocity = target_velocity
                return
        sign = 1.0
        if way < 0.0 or (way == 0.0 and velocity > 0.0):
            sign, way, velocity = -1.0, -way, -velocity
        # The fastest end of this period from which `braking` still stops at the target:
        # v'^2 <= 2 braking (way - (v + v') period / 2), solved for v'.
        root = brake * (0.25 * brake - velocity) + 2.0 * braking * way
        fastest = sqrt(root) - 0.5 * brake if root > 0.0 else -inf
        cruise = speed - sign * target_velocity
        if fastest > cruise:
            fastest = cruise
        if fastest > velocity + change:
            fastest = velocity + change
        elif fastest < velocity - change:
            fastest = velocity - change
        end = target_velocity + sign * fastest
        self.position += 0.5 * period_s * (self.velocity + end)
        self.velocity = end

    def stopping_point(self, braking: float) -> float:
        """Return where the set-point comes to rest if it brakes from now on."""
        return self.position + 0.5 * self.velocity * abs(self.velocity) / braking
