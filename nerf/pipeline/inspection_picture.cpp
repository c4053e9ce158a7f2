#include "nerf/pipeline/inspection_picture.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "nerf/output/draw_text.h"

namespace nerf {
namespace {

constexpr int kWidth = 1280, kHeight = 480;
constexpr int kLeft = 70, kTop = 50, kBottom = 60, kMiddle = 90, kRight = 20;  // margins
constexpr int kSideWidth = (kWidth - kLeft - kMiddle - kRight) / 2;
constexpr int kSideHeight = kHeight - kTop - kBottom;
constexpr int kTitle = 16, kLabel = 13;                      // text sizes, pixels
constexpr int kLines = 4;                                    // intervals between grid lines
constexpr double kSmallestStops = 0.1, kSmallestChange = 2;  // smallest range of an axis

using Rgb = std::array<float, 3>;
constexpr Rgb kGrid = {0.87f, 0.87f, 0.87f}, kAxis = {0.35f, 0.35f, 0.35f};
constexpr Rgb kBar = {0.18f, 0.42f, 0.69f}, kLight = {0.70f, 0.81f, 0.92f};

// Rounds up to 1, 2 or 5 times a power of ten.
double RoundedUp(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (value <= step * power * (1 + 1e-9)) return step * power;
  }
  return 10 * power;
}

// One of the two plots of the picture.
class Plot {
 public:
  Plot(Image& image, int left, double lowest, double highest)
      : image_(image), left_(left), lowest_(lowest), highest_(highest) {}

  // Pixel coordinates of a position on the axes.
  //   x  from 0 to 1    y  from lowest to highest
  int Column(double x) const { return left_ + static_cast<int>(std::lround(x * kSideWidth)); }
  int Row(double y) const {
    const double share = (y - lowest_) / (highest_ - lowest_);
    return kTop + kSideHeight - static_cast<int>(std::lround(share * kSideHeight));
  }
  // Fills a rectangle, at least one pixel thick.
  void Fill(double x0, double x1, double y0, double y1, const Rgb& color) {
    const int top = std::min(Row(y0), Row(y1)), bottom = std::max(Row(y0), Row(y1));
    for (int y = std::max(0, top); y <= std::min(kHeight - 1, bottom); ++y) {
      for (int x = Column(x0); x < std::max(Column(x1), Column(x0) + 1); ++x) {
        std::ranges::copy(color, image_.At(x, y));
      }
    }
  }
  void Grid() {
    for (int line = 0; line <= kLines; ++line) {
      const double y = lowest_ + (highest_ - lowest_) * line / kLines;
      Fill(0, 1, y, y, std::fabs(y) < 1e-9 ? kAxis : kGrid);
      DrawText(fmt::format("{:.3g}", std::fabs(y) < 1e-9 ? 0.0 : y), left_ - 8, Row(y) + 5, kLabel,
               image_, TextAlign::kRight);
    }
  }
  void Titles(const std::string& title, const std::string& x_axis) {
    DrawText(title, left_, kTop - 20, kTitle, image_);
    DrawText(x_axis, Column(0.5), kHeight - 14, kLabel, image_, TextAlign::kCenter);
  }
  void Tick(double x, const std::string& text) {
    DrawText(text, Column(x), kTop + kSideHeight + 20, kLabel, image_, TextAlign::kCenter);
  }
  void NoData(const std::string& reason) {
    DrawText(reason, Column(0.5), kTop + kSideHeight / 2, kTitle, image_, TextAlign::kCenter);
  }

 private:
  Image& image_;
  int left_;
  double lowest_, highest_;
};

void DrawExposures(const std::vector<double>& stops, Image& image) {
  double largest = kSmallestStops;
  for (const double s : stops) largest = std::max(largest, std::fabs(s));
  largest = RoundedUp(largest);
  Plot plot(image, kLeft, -largest, largest);
  plot.Titles("exposure of each photograph relative to the mean, stops",
              "photographs in the order of their names");
  if (stops.empty()) return plot.NoData("no evidence on exposures");
  plot.Grid();
  const auto count = static_cast<double>(stops.size());
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const auto at = static_cast<double>(i);
    plot.Fill((at + 0.15) / count, (at + 0.85) / count, 0, stops[i], kBar);
  }
  plot.Tick(0.5 / count, "1");
  plot.Tick(1 - 0.5 / count, fmt::format("{}", stops.size()));
}

void DrawResiduals(const std::vector<AngleResiduals>& residuals, Image& image) {
  double largest = kSmallestChange, widest = 30;  // degrees
  for (const AngleResiduals& r : residuals) {
    largest = std::max(largest, r.quartiles[2]);
    widest = std::max(widest, r.degrees + 2.5);
  }
  Plot plot(image, kLeft + kSideWidth + kMiddle, 0, RoundedUp(largest));
  plot.Titles("colour change of points over what texture explains: median, quartiles",
              "degrees between the view and the mean view of the point");
  if (residuals.empty()) return plot.NoData("no sparse points");
  plot.Grid();
  plot.Fill(0, 1, 1, 1, kAxis);  // as much as texture explains
  for (const AngleResiduals& r : residuals) {
    const double x0 = (r.degrees - 2) / widest, x1 = (r.degrees + 2) / widest;
    plot.Fill(x0, x1, r.quartiles[0], r.quartiles[2], kLight);
    const double thick = RoundedUp(largest) / kSideHeight;
    plot.Fill(x0, x1, r.quartiles[1] - thick, r.quartiles[1] + thick, kBar);
  }
  for (int degrees = 0; degrees <= widest; degrees += 10) {
    plot.Tick(degrees / widest, fmt::format("{}", degrees));
  }
}

}  // namespace

Image PictureOf(const Inspection& inspection) {
  Image image(kWidth, kHeight, 3);
  std::ranges::fill(image.pixels, 1.0f);
  DrawExposures(inspection.stops, image);
  DrawResiduals(inspection.residuals, image);
  return image;
}

}  // namespace nerf
