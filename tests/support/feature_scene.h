#pragma once

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "nerf/kernels/descriptor_matching.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/posed_images.h"
#include "sfm/feature_matching.h"

namespace nerf::test {

// Points in a cube about the origin, seen by cameras on a circle around it, and the features that a
// detector would find of them: with noise in position and descriptor, in another order in each
// photograph, and some of nothing.
struct FeatureScene {
  struct Options {
    int images = 8, points = 300;
    double noise = 0.4;     // of a position, pixels
    double spurious = 0.2;  // features of nothing, as a share
    bool opaque = false;    // points are seen from their side of the origin only
    double arc = 0.3;       // radians between neighbours
    std::uint32_t seed = 1;
  };

  explicit FeatureScene(const Options& options) {
    std::mt19937 generator(options.seed);
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> uniform(-1, 1);
    posed.cameras = {{CameraModel::kOpenCV, 640, 480, {500, 500, 320, 240, 0.05, -0.02, 0, 0}}};
    std::vector<std::vector<std::uint8_t>> looks;
    for (int i = 0; i < options.points; ++i) {
      points.emplace_back(uniform(generator), uniform(generator), uniform(generator));
      looks.push_back(RandomDescriptor(generator));
    }
    for (int i = 0; i < options.images; ++i) {
      const double angle = options.arc * i;
      const Eigen::Vector3d centre(5 * std::sin(angle), 0.4 * std::sin(3 * angle),
                                   -5 * std::cos(angle));
      Eigen::Matrix3d axes;
      axes.col(2) = -centre.normalized();
      axes.col(0) = Eigen::Vector3d::UnitY().cross(axes.col(2)).normalized();
      axes.col(1) = axes.col(2).cross(axes.col(0));
      PosedImage image;
      image.name = fmt::format("p{}.png", 100 + i);
      image.path = image.name;
      image.world_from_camera = Eigen::Translation3d(centre) * Eigen::Quaterniond(axes);
      posed.images.push_back(image);
      features.push_back(Observe(posed.images.back(), looks, options, generator));
    }
  }

  // The true reconstruction of the first images.
  PosedImages Reconstruction(std::size_t images) const {
    PosedImages model = posed;
    model.images.resize(images);
    for (std::size_t p = 0; p < points.size(); ++p) {
      SparsePoint point;
      point.x_in_world = points[p];
      for (std::size_t i = 0; i < images; ++i) {
        for (std::size_t f = 0; f < point_of_feature[i].size(); ++f) {
          if (point_of_feature[i][f] != static_cast<int>(p)) continue;
          point.track.push_back({static_cast<int>(i), features[i].positions[f].cast<double>()});
        }
      }
      if (point.track.size() >= 2) model.points.push_back(point);
    }
    return model;
  }

  PosedImages posed;                               // without points
  std::vector<Eigen::Vector3d> points;             // true ones
  std::vector<sfm::Features> features;             // of each image
  std::vector<std::vector<int>> point_of_feature;  // [image][feature]; -1 of nothing

 private:
  // A positive vector of length 512.
  static std::vector<std::uint8_t> Quantized(const Eigen::VectorXd& vector) {
    std::vector<std::uint8_t> descriptor;
    const double scale = 512 / vector.norm();
    for (const double v : vector) {
      descriptor.push_back(static_cast<std::uint8_t>(std::clamp(v * scale, 0.0, 255.0)));
    }
    return descriptor;
  }
  static std::vector<std::uint8_t> RandomDescriptor(std::mt19937& generator) {
    std::exponential_distribution<double> exponential;
    Eigen::VectorXd vector(kernels::kDescriptorSize);
    for (double& v : vector) v = std::pow(exponential(generator), 2);
    return Quantized(vector.cwiseMin(10));
  }

  sfm::Features Observe(const PosedImage& image,
                        const std::vector<std::vector<std::uint8_t>>& looks, const Options& options,
                        std::mt19937& generator) {
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> uniform(0, 1);
    struct Seen {
      Eigen::Vector2d pixel;
      std::vector<std::uint8_t> descriptor;
      int point;
    };
    std::vector<Seen> seen;
    const Camera& camera = posed.cameras[image.camera];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto pixel = PixelFromPoint(camera, image.world_from_camera.inverse() * points[i]);
      const bool behind = image.world_from_camera.translation().dot(points[i]) < 0;
      if (!pixel || (options.opaque && behind)) continue;
      Eigen::VectorXd look(kernels::kDescriptorSize);
      for (int k = 0; k < look.size(); ++k) {
        look[k] = std::max(0.0, looks[i][k] + 6 * gauss(generator));
      }
      seen.push_back({*pixel + options.noise * Eigen::Vector2d(gauss(generator), gauss(generator)),
                      Quantized(look), static_cast<int>(i)});
    }
    const auto spurious = static_cast<std::size_t>(options.spurious * seen.size());
    for (std::size_t i = 0; i < spurious; ++i) {
      seen.push_back({{camera.width * uniform(generator), camera.height * uniform(generator)},
                      RandomDescriptor(generator),
                      -1});
    }
    std::shuffle(seen.begin(), seen.end(), generator);
    sfm::Features found;
    std::vector<int> point_of;
    for (const Seen& s : seen) {
      found.positions.push_back(s.pixel.cast<float>());
      found.scales.push_back(static_cast<float>(2 + 8 * uniform(generator)));
      found.descriptors.insert(found.descriptors.end(), s.descriptor.begin(), s.descriptor.end());
      point_of.push_back(s.point);
    }
    point_of_feature.push_back(point_of);
    return found;
  }
};

}  // namespace nerf::test
