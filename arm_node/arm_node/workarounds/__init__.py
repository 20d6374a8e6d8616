"""Workarounds for faults and costs of the libraries below.

Each is made for certain versions of a library. With any other version it is off, and the process
logs that in one line. `ARM_WITHOUT=name,name` switches workarounds off by hand, `ARM_WITHOUT=all`
all of them; see `switch`. torn_ports, lost_ports and signs_of_life are in the module `ports`,
stamp_clock and process_clock in `clocks`, and the others in modules of their names.
`plain_programs` gives discovery and lost_ports to programs of plain rclpy that the suite starts.

| name                 | works around                                | library          | upstream |
| -------------------- | ------------------------------------------- | ---------------- | -------- |
| discovery            | Fast DDS announces itself before it listens | rmw_fastrtps     |          |
| signs_of_life        | a late sender sleeps for up to 333 ms       | rmw_fastrtps     | [6535]   |
| torn_ports           | a killed process's port hangs the next one  | rmw_fastrtps     | [1144]   |
| lost_ports           | a new process's port is removed by a sender | rmw_fastrtps     |          |
| exit_pause           | a process sleeps for 0.1 s before it ends   | rmw_fastrtps     |          |
| deadlocked_end       | Fast DDS deadlocks when processes stop      | rmw_fastrtps     | [6502]   |
| private_files        | all users can read Fast DDS's shared memory | rmw_fastrtps     |          |
| local_profile        | LOCALHOST doubles a profile's transports    | rmw_fastrtps     | [653]    |
| message_template     | rclpy serialises whole messages each cycle  | rclpy            | [836]    |
| joint_state_encoding | rclpy creates objects for unused fields     | rclpy            | [836]    |
| stamp_clock          | listening to /clock costs a tenth of a core | rclpy            | [1378]   |
| process_clock        | as above, for each node of the simulation   | rclpy            | [1378]   |
| serialized_goals     | a large goal stops the control loop         | rclpy            | [836]    |
| parameter_types      | an unknown parameter type gets no answer    | rclpy            |          |
| lazy_messages        | one message imports all of its package      | rclpy            |          |
| profiler             | MuJoCo reads the clock 20 times in a step   | MuJoCo           |          |
| patch_releases       | MuJoCo refuses models saved by 4.0.x        | MuJoCo           |          |
| parse_cache          | every generator parses every definition     | rosidl           |          |
| template_cache       | EmPy scans every template for every file    | EmPy             |          |

Where the last column is empty, no upstream issue is known. The versions are those of ROS 2 Jazzy
(rmw_fastrtps 8.4 on Fast DDS 2.14, rclpy 7.1, rosidl 4.6) and of Kilted (9.3 on 3.2, 9.1, 4.9),
MuJoCo 4.0 and EmPy 4. `serialized_goals` is beside its controller, in
`arm_control.controllers.joint_trajectory`; the last two belong to the build of `arm_interfaces`, in
its `interface_build`.

All but `deadlocked_end`, which was found on Kilted, are made for Jazzy, and all are on with both,
as measured there: the fault exists, or a figure gets better by a tenth. The two of MuJoCo do not
depend on ROS. `benchmarks/RESULTS.md` has the figures.

[6535]: https://github.com/eProsima/Fast-DDS/issues/6535
[6502]: https://github.com/eProsima/Fast-DDS/issues/6502
[1144]: https://github.com/eProsima/Fast-DDS/issues/1144
[653]: https://github.com/ros2/rmw_fastrtps/pull/653
[836]: https://github.com/ros2/rclpy/issues/836
[1378]: https://github.com/ros2/rclpy/issues/1378
"""
