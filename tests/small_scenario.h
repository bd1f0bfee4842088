/// One glider filmed both ways in a small image: enough for every step of the analysis, and rendered in seconds.
#pragma once

namespace glidelab::tests {

inline constexpr const char* kSmallScenario = R"(format = 1
name = "small"
seed = 5

[camera]
width_px = 400
height_px = 300
frame_rate_hz = 100.0
focal_px = [600.0, 600.0]
position_m = [0.05, 0.08, 2.40]
target_m = [0.0, 0.0, 0.0]

[calibration]
inner_corners = [7, 5]
square_m = 0.08
views = 6

[marker]
diameter_m = 0.03

[[configuration]]
name = "m1"
mass_kg = 0.335
incline_deg = 4.3110
stated_incline_deg = 4.0
stated_incline_sd_deg = 0.3
[[configuration.force]]
law = "viscous"
k_over_m_1_s = 2.7680
[[configuration.force]]
law = "coulomb"
mu = 0.0071
[[configuration.clip]]
name = "up"
launched = "up"
x0_m = 0.2
v0_m_s = -1.3
duration_s = 1.7
[[configuration.clip]]
name = "down"
launched = "down"
x0_m = -0.45
v0_m_s = 1.2
duration_s = 1.2
)";

}  // namespace glidelab::tests
