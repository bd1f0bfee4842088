#include "core/experiment/experiment_template.h"

#include <fmt/format.h>

#include "base/toml/toml_set.h"

namespace glidelab::core {
namespace {

constexpr std::string_view kToml =
    R"(# Lengths are in metres, times in seconds, angles in degrees, masses in kilograms.
# A line "#key = value" is an optional key: remove the # to use it. A misspelt key is an error.

#gravity_m_s2 = 9.8123             # local value: 9.78 (equator) to 9.83 (poles); default 9.80665 ± 0.015
#gravity_sd_m_s2 = 0.0001          # its standard deviation; by default that of the last digit
#recorded_by = "camera"            # "sensor" if all positions are a motion sensor's: then no effect of a camera is considered

# ---- The camera: as it was set, or as its data sheet says.
[camera]
frame_rate_hz = 240.0              # what it filmed at; the file may play at another rate
#exposure_s = 0.001                # exposure time of one frame; a short one keeps the marker sharp
#shutter = "global"                # or "rolling" (phones, webcams): then state line_readout_s
#line_readout_s = 0.00002          # rolling only: time from one row to the next
#first_row = "top"                 # rolling only: the row that is read first, "top" or "bottom" (camera upside down)
#bit_depth = 8                     # 8 to 16
#time = "rate"                     # frame k is at k / frame_rate_hz; "container": at the file's own time stamp

# ---- The pattern: the chessboard that "glidelab pattern" draws, printed and glued to something flat.
[calibration]
pattern = "chessboard"
inner_corners = [9, 6]             # where four squares meet; a board of 10 x 7 squares has 9 x 6
square_m = 0.025                   # side of one square AS PRINTED: measure 9 in a row with a ruler
views = "calibration/view-*.png"   # a dozen images: tilted in all directions, near and far, out to the image's corners
plane = "calibration/plane.png"    # the pattern where the marker moves, its long side along the track; several images
                                   # along the track are better: "calibration/plane-*.png"

# ---- Or, instead of [calibration], one scale: no lens is corrected, and all lengths are as good as this one.
#[scale]
#px_per_m = 480.0                  # or from_px, to_px and length_m together
#from_px = [100.0, 240.0]          # two points of the image ...
#to_px = [580.0, 240.0]
#length_m = 1.0                    # ... and how far apart they are in the plane of motion
#px_per_m_sd = 5.0                 # standard deviation of the scale

# ---- A plumb line in the image, which gives the inclination (and with it mu from a single direction).
#[plumb]
#view = "plumb.png"
#region = [40, 0, 120, 500]        # x, y, width, height in pixels, around the line

# ---- The marker: a disc or ball that contrasts with everything near its path.
[marker]
diameter_m = 0.016                 # AS PRINTED: the sheet of "glidelab pattern" has discs of 8, 12, 16 and 24 mm
#height_m = 0.0                    # distance of its centre from the pattern's plane, towards the camera
#color = "#101010"                 # a black disc (left out, a bright one is looked for first); or the hue of an object, such as "#e04020"
#start_px = [400, 120]             # where it is in the frame at start_s, or in the first one, if something else moves as well

[track]
downhill = "+X"                    # which direction of the pattern's long row is down; it runs from the side with black
                                   # corner squares to that with white ones; level track: the one you call positive.
                                   # With [scale]: "+X" is to the right in the image, "+Y" down
#length_m = 2.0

# ---- The clips, one [[clip]] for each motion. mu and the inclination need both directions: launch it both ways, or up a
#      slope that it comes back down. Several masses give more information than one.
[[clip]]
name = "m1-up"
file = "clips/m1-up.mp4"           # a video, or a folder of frames
#track = "tracks/m1-up.csv"        # instead of file, for a motion tracked elsewhere: t_s,x_m; an export or project of Tracker, ...
#column = "x"                      # of an export with several columns: which one is x, by header or number; of a project the mass
mass_kg = 0.335                    # glider with marker and load
#mass_sd_kg = 0.0005               # standard deviation of the mass
incline_deg = 4.0                  # of the track, as set; one reading for all clips of a group
#incline_sd_deg = 0.3              # its standard deviation
launched = "up"                    # "up" (towards -x), "down" (towards +x) or "released"
#start_s = 0.2                     # the part of the clip in which the glider moves freely; ...
#end_s = 1.8                       # ... without them the analysis finds it
#start_px = [90, 120]              # where the marker is at start_s, or in the first frame; replaces that of [marker]
#group = "slope"                   # clips that share one inclination; default: those of equal incline_deg

[[clip]]
name = "m1-down"
file = "clips/m1-down.mp4"
mass_kg = 0.335
incline_deg = 4.0
launched = "down"

# ---- What one set-up has of its own, where the track or camera was moved between clips.
#[[group]]
#name = "slope"
#plane = "calibration/plane.png"
#plumb = { view = "plumb.png", region = [40, 0, 120, 500] }
#downhill = "+X"

# ---- Your own notes; nothing here is read.
[extra]
notes = ""
)";

constexpr std::string_view kReadme = R"(
What goes where, and what follows. `experiment.toml` explains every key.

1. **Pattern.** `glidelab pattern` draws a chessboard and markers to print. Print at 100 %, check the ruler line, glue the
   board flat, and write the side of a square *as measured* into `experiment.toml`.
2. **Camera.** On something that does not move, at right angles to the track. Focus, exposure and zoom fixed; short exposure, much
   light. From here on do not touch the camera.
3. **`calibration/`.** `view-00.png`, `view-01.png`, …: a dozen images of the board, tilted in all directions, near and far,
   reaching into all corners of the image. `plane.png`: the board held where the marker will move, its long side along the track.
4. **`clips/`.** One clip for each motion, both directions, and more than one mass if you can. In `experiment.toml`, state the mass, the
   inclination and the launch of each.

Then, before you put anything away:

    glidelab check .       # is the recording good enough? what to change
    glidelab analyze .     # K/m, mu, inclination, terminal velocity
    glidelab certify .     # can the uncertainties be trusted?
    glidelab diagnose .    # what the simple law does not explain, if anything
)";

}  // namespace

std::string experiment_template(std::string_view name) {
  return fmt::format("format = 1\nname = {}\n\n{}", base::toml_string(name), kToml);
}

std::string experiment_readme(std::string_view name) {
  return fmt::format("# {}\n{}", name, kReadme);
}

}  // namespace glidelab::core
