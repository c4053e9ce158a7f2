#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "nerf/light/lights.h"

namespace nerf::test {

// Directions to `count` lights around z, two thirds at an angle of `degrees` to it and one third at
// half of that, so that they are not coplanar.
inline std::vector<DirectionalLight> RingOfLights(int count, double degrees) {
  std::vector<DirectionalLight> lights;
  for (int i = 0; i < count; ++i) {
    const double polar = degrees * std::numbers::pi / 180 * (i % 3 == 2 ? 0.5 : 1.0);
    const double azimuth = 2 * std::numbers::pi * i / count;
    lights.push_back({Eigen::Vector3d(std::sin(polar) * std::cos(azimuth),
                                      std::sin(polar) * std::sin(azimuth), std::cos(polar))});
  }
  return lights;
}

// Errors in the images of a sphere.
struct SphereFlaws {
  double noise = 0;       // standard deviation, relative to white
  double shadows = 0;     // share of observations with a cast shadow
  double highlights = 0;  // share of observations with a highlight
  unsigned seed = 1;
};

// A pixel of a matt sphere under orthographic projection: its normal, and its radiance under each
// light, albedo * max(0, l . n).
struct SpherePixel {
  Eigen::Vector3d normal;
  std::vector<double> observations;
};

inline std::vector<SpherePixel> LitSphere(const std::vector<DirectionalLight>& lights,
                                          double albedo, const SphereFlaws& flaws = {},
                                          int radius = 40) {
  std::mt19937 random(flaws.seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal_noise(0, 1);
  std::vector<SpherePixel> pixels;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      const double r2 = (x * x + y * y) / static_cast<double>(radius * radius);
      if (r2 >= 1) continue;
      SpherePixel pixel{{x / double(radius), y / double(radius), std::sqrt(1 - r2)}, {}};
      for (const auto& light : lights) {
        double b = albedo * std::max(0.0, light.to_light.dot(pixel.normal));
        const double u = uniform(random);
        if (u < flaws.shadows) {
          b = 0;
        } else if (u < flaws.shadows + flaws.highlights) {
          b += albedo * (0.3 + 0.7 * uniform(random));
        }
        if (flaws.noise > 0) b = std::max(0.0, b + flaws.noise * normal_noise(random));
        pixel.observations.push_back(b);
      }
      pixels.push_back(std::move(pixel));
    }
  }
  return pixels;
}

inline double DegreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

}  // namespace nerf::test
