#pragma once

#include <span>
#include <string>
#include <vector>

namespace sumogamma {

/// One set of points of a picture; its number gives its colour and its shape.
struct PlotSeries {
  std::string name;
  std::vector<double> x, y;
};

struct PlotFrame {
  std::string title, x_label, y_label;
  double width = 420, height = 260;  ///< [px]
  bool square = false;               ///< one scale for both axes: a map
};

/// Points of several series in one picture, as an SVG element. Values that aren't finite are left
/// out. A picture without a point says so.
std::string scatter_svg(const PlotFrame& frame, std::span<const PlotSeries> series);

/// Shares of values (`x` of each series) in `bins` equal bins of what all cover up to their 99th
/// percentile, as lines.
std::string histogram_svg(const PlotFrame& frame, std::span<const PlotSeries> series,
                          std::size_t bins);

/// One line a series, its values as marks on a common axis.
std::string strip_svg(const PlotFrame& frame, std::span<const PlotSeries> series);

/// An interval on an axis from -reach to reach around a line at 0.
std::string interval_svg(double low, double middle, double high, double reach);

}  // namespace sumogamma
