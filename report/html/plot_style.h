/// What all plots share: colours that colour-blind readers can tell apart, also in grey print, and the frame of a plot.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace glidelab::report {

/// Okabe and Ito, "Color universal design" (2008), without the yellow that white paper swallows.
inline constexpr std::array<std::string_view, 7> kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                            "#56b4e9", "#e69f00", "#000000"};
/// What stands behind the data or is left out; the ground of such a stretch.
inline constexpr std::string_view kGrey = "#9a9a9a";
inline constexpr std::string_view kShade = "#ececec";

/// Of the n-th series; they come again after the last.
inline std::string color(std::size_t index) {
  return std::string(kColors[index % kColors.size()]);
}

/// Thin frame at the left and below, light grid, the legend above, and some room around the points.
inline constexpr std::string_view kFrame =
    "set border 3 lw 1 lc rgb '#555555'\n"
    "set tics nomirror out scale 0.6\n"
    "set grid xtics ytics back lw 0.6 lc rgb '#dddddd'\n"
    "set key outside top center horizontal samplen 1.2 font ',14'\n"
    "set xtics autofreq\nset ytics autofreq\n"
    "set pointintervalbox 0.01\n"  // 0 is 1: gnuplot clears a disc of that size below a point with bars, and bars in it
    "set offsets graph 0.02, graph 0.02, graph 0.06, graph 0.06\n";

}  // namespace glidelab::report
