#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <variant>

#include "nerf/image/color.h"

namespace nerf::synthetic {

// The linear colour of an sRGB value in hexadecimal, e.g. 0xd9a441.
Color ColorFromSrgbHex(std::uint32_t rgb);

// Solid textures: functions of a point in space, so that surfaces need no texture coordinates. They
// are built from hashes of lattice cells and never repeat, so that features match unambiguously.
// Lengths are in scene units.

// The same colour everywhere.
struct Plain {
  Color color = Color::Constant(0.5);
};

// A colour ramp driven by fractal noise: veins and clouds at every scale.
struct Marble {
  std::array<Color, 4> ramp;
  double frequency = 4;  // of the coarsest octave, 1 / scene unit
  int octaves = 5;
  std::uint32_t seed = 0;
};

// Cubes of one size and various colours and brightnesses, with mortar between them.
struct Mosaic {
  std::array<Color, 4> palette;
  Color mortar = Color::Zero();
  double tile = 0.1;   // edge of a cube, scene units
  double joint = 0.1;  // width of a joint, as a fraction of the tile
  int period = 0;      // cells after which the pattern repeats; 0: never
  std::uint32_t seed = 0;
};

// Chips of several sizes in a mottled base.
struct Terrazzo {
  Color base = Color::Constant(0.5);
  std::array<Color, 4> chips;
  double largest = 0.3;  // cell size of the largest chips, scene units; halved at each level
  int levels = 3;
  std::uint32_t seed = 0;
};

// A sky with clouds, a function of the direction.
struct Sky {
  Color zenith = Color::Constant(0.5);
  Color horizon = Color::Constant(0.5);
  Color cloud = Color::Constant(0.5);
  double frequency = 4;
  std::uint32_t seed = 0;
};

using Texture = std::variant<Plain, Marble, Mosaic, Terrazzo, Sky>;

// The colour of a texture at a point; in [0, 1] if the colours of the texture are.
Color Evaluate(const Texture& texture, const Eigen::Vector3d& x);

// Gradient noise: smooth, zero at the lattice points, of wavelength about 1, within [-1, 1].
// Source: Perlin 2002, "Improving Noise".
double GradientNoise(const Eigen::Vector3d& x, std::uint32_t seed);

// The sum of `octaves` gradient noises, each with twice the frequency and 0.6 times the amplitude
// of the previous one, scaled so that most values are in [-1, 1].
double FractalNoise(const Eigen::Vector3d& x, int octaves, std::uint32_t seed);

}  // namespace nerf::synthetic
