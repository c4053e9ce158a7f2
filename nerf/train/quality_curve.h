#pragma once

#include <optional>
#include <vector>

namespace nerf {

// Validation PSNR against training seconds, what its decibels cost, and a forecast of the next.
//
// PSNR rises about in proportion to the logarithm of time, and ever more slowly: the forecast goes
// on from a line fitted in ln(seconds) to the last three quarters of the run, at seven tenths of
// its slope. On nine recorded runs of three captures (tests/nerf/train/recorded_curves.json), from
// the fourth point on, the seconds that 0.5 dB more took are within a factor of three of the
// forecast in four cases of five (a factor of 1.6 in the middle), and from three tenths of a run on
// its last PSNR within 0.4 dB in four of five.
class QualityCurve {
 public:
  // Seconds must rise from point to point; others, and what is not finite, are ignored.
  void Add(double seconds, double psnr);

  std::optional<double> Last() const;  // PSNR
  // Seconds that it took to become better by the last `gain` dB. Nothing before it did.
  std::optional<double> SecondsOfLast(double gain) const;
  // Seconds that `gain` dB more will take; infinity where the curve does not rise. Nothing before
  // the fourth point.
  std::optional<double> SecondsForNext(double gain) const;
  // PSNR at a later time. Nothing before the fourth point.
  std::optional<double> PsnrAt(double seconds) const;

 private:
  struct Point {
    double seconds, psnr;
  };
  // psnr = level + slope ln(seconds / those of the last point)
  struct Line {
    double level, slope;
  };
  std::optional<Line> Fit() const;

  std::vector<Point> points_;
};

}  // namespace nerf
