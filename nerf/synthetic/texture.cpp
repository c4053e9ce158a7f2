#include "nerf/synthetic/texture.h"

#include <algorithm>
#include <cmath>

#include "nerf/image/srgb.h"
#include "nerf/synthetic/hash.h"

namespace nerf::synthetic {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

Color Mix(const Color& a, const Color& b, double t) { return a + (b - a) * t; }

double SmoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Vector3i Floor(const Vector3d& x) {
  return Vector3d(std::floor(x.x()), std::floor(x.y()), std::floor(x.z())).cast<int>();
}

// Scales a colour and keeps it a reflectance.
Color Shade(const Color& color, double factor) { return (color * factor).max(0.0).min(1.0); }

// The edge directions of a cube; four of the twelve are listed twice, so that four bits select one.
constexpr double kEdges[16][3] = {
    {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
    {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}, {1, 1, 0}, {-1, 1, 0}, {0, -1, 1}, {0, -1, -1}};

double EdgeDot(std::uint32_t hash, double x, double y, double z) {
  const double* edge = kEdges[hash & 15];
  return edge[0] * x + edge[1] * y + edge[2] * z;
}

double Fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

Color At(const Plain& plain, const Vector3d&) { return plain.color; }

Color At(const Marble& marble, const Vector3d& x) {
  const double noise = FractalNoise(x * marble.frequency, marble.octaves, marble.seed);
  const double position = std::clamp(0.5 + 0.9 * noise, 0.0, 1.0) * 3;
  const int band = std::min(static_cast<int>(position), 2);
  return Mix(marble.ramp[band], marble.ramp[band + 1], position - band);
}

Color At(const Mosaic& mosaic, const Vector3d& x) {
  // The offset of half a tile keeps the faces of a box, at multiples of the tile, off the joints.
  Vector3d p = x / mosaic.tile + Vector3d::Constant(0.5);
  if (mosaic.period > 0) p -= mosaic.period * Floor(p / mosaic.period).cast<double>();
  const Vector3i cell = Floor(p);
  const double grain = FractalNoise(p * 2.0, 2, mosaic.seed + 1);
  const Vector3d from_edge =
      Vector3d::Constant(0.5) - (p - cell.cast<double>() - Vector3d::Constant(0.5)).cwiseAbs();
  const std::uint32_t hash = Hash(cell.x(), cell.y(), cell.z(), mosaic.seed);
  const Color tile = Shade(mosaic.palette[hash & 3], 0.55 + 0.6 * UnitFromHash(Hash(hash)));
  const double inside = SmoothStep(0, mosaic.joint, from_edge.minCoeff() + 0.06 * grain);
  return Shade(Mix(mosaic.mortar, tile, inside), 1 + 0.25 * grain);
}

Vector3d PointFromHash(std::uint32_t hash) {  // in [-0.5, 0.5]^3
  return Vector3d(hash & 1023, hash >> 10 & 1023, hash >> 20 & 1023) / 1023 -
         Vector3d::Constant(0.5);
}

// Whether a point is in a shard: a ball cut off by a few random planes.
bool InShard(const Vector3d& from_centre, double radius, std::uint32_t hash) {
  if (from_centre.squaredNorm() > radius * radius) return false;
  for (int plane = 0; plane < 6; ++plane) {
    hash = Hash(hash);
    const Vector3d normal = PointFromHash(hash);
    if (from_centre.dot(normal) > 0.6 * radius * normal.norm()) return false;
  }
  return true;
}

Color At(const Terrazzo& terrazzo, const Vector3d& x) {
  const double mottle = FractalNoise(x * (2 / terrazzo.largest), 4, terrazzo.seed);
  double size = terrazzo.largest;
  for (int level = 0; level < terrazzo.levels; ++level, size /= 2) {
    // A chip is inside its cell, so that one cell has to be tested for each level.
    const Vector3d p = x / size + Vector3d::Constant(0.37 * level + 0.13);
    const Vector3i cell = Floor(p);
    const std::uint32_t hash = Hash(cell.x(), cell.y(), cell.z(), terrazzo.seed + 7 + level);
    const std::uint32_t second = Hash(hash);
    const double radius = 0.26 + 0.22 * UnitFromHash(second);
    const Vector3d centre = Vector3d::Constant(0.5) + PointFromHash(hash) * 2 * (0.5 - radius);
    if (!InShard(p - cell.cast<double>() - centre, radius, second)) continue;
    return Shade(terrazzo.chips[second & 3],
                 0.8 + 0.4 * UnitFromHash(Hash(second)) + 0.15 * mottle);
  }
  return Shade(terrazzo.base, 1 + 0.17 * mottle);
}

Color At(const Sky& sky, const Vector3d& x) {
  const double height = std::clamp(x.z(), 0.0, 1.0);
  const Color clear = Mix(sky.horizon, sky.zenith, std::sqrt(height));
  const Vector3d stretched(x.x(), x.y(), 2.2 * x.z());
  const double clouds = FractalNoise(stretched * sky.frequency, 4, sky.seed);
  return Mix(clear, sky.cloud, SmoothStep(-0.3, 0.8, clouds));
}

}  // namespace

Color ColorFromSrgbHex(std::uint32_t rgb) {
  const auto channel = [rgb](int shift) {
    return static_cast<double>(LinearFromSrgb(static_cast<float>(rgb >> shift & 255) / 255));
  };
  return {channel(16), channel(8), channel(0)};
}

Color Evaluate(const Texture& texture, const Vector3d& x) {
  return std::visit([&x](const auto& t) { return At(t, x); }, texture);
}

double GradientNoise(const Vector3d& x, std::uint32_t seed) {
  const Vector3i cell = Floor(x);
  const Vector3d f = x - cell.cast<double>();
  const double u = Fade(f.x()), v = Fade(f.y()), w = Fade(f.z());
  double corner[8];
  for (int i = 0; i < 8; ++i) {
    const int dx = i & 1, dy = i >> 1 & 1, dz = i >> 2;
    corner[i] = EdgeDot(Hash(cell.x() + dx, cell.y() + dy, cell.z() + dz, seed), f.x() - dx,
                        f.y() - dy, f.z() - dz);
  }
  const auto lerp = [](double a, double b, double t) { return a + (b - a) * t; };
  return lerp(lerp(lerp(corner[0], corner[1], u), lerp(corner[2], corner[3], u), v),
              lerp(lerp(corner[4], corner[5], u), lerp(corner[6], corner[7], u), v), w);
}

double FractalNoise(const Vector3d& x, int octaves, std::uint32_t seed) {
  constexpr double kGain = 0.6;
  double sum = 0;
  double amplitude = 1;
  double power = 0;
  Vector3d p = x;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += amplitude * GradientNoise(p, seed + 101U * static_cast<std::uint32_t>(octave));
    power += amplitude * amplitude;
    amplitude *= kGain;
    // The shift keeps the octaves from all being zero at the origin.
    p = 2 * p + Vector3d(0.37, 0.71, 0.53);
  }
  // Gradient noise has a standard deviation of about 0.26; two of them reach 1.
  return sum / std::sqrt(power) * 1.9;
}

}  // namespace nerf::synthetic
