#include "nerf/geometry/shape_list.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace nerf {
namespace {

using Eigen::Vector3d;

struct Item {
  Shape shape;
};

// Spheres and rotated boxes at random positions, with coordinates within 3.
std::vector<Item> RandomItems(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-3, 3), size(0.2, 1.2), degrees(0, 360);
  const auto point = [&] {
    const double x = place(random), y = place(random), z = place(random);
    return Vector3d(x, y, z);
  };
  std::vector<Item> items;
  for (int i = 0; i < 4; ++i) {
    const double radius = size(random);
    items.push_back({Sphere{point(), radius}});
    const Vector3d half_size(size(random), size(random), size(random));
    items.push_back({Box{point(), half_size, HeadingFromDegrees(degrees(random))}});
  }
  return items;
}

bool Contains(const Shape& shape, const Vector3d& x_in_world) {
  const Vector3d x = ShapeFromWorld(shape, x_in_world);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return x.norm() < sphere->radius;
  return ((x.cwiseAbs() - std::get<Box>(shape).half_size).array() < 0).all();
}

// The first distance, in steps of `step`, at which a ray enters or leaves an item.
double FirstHitByMarching(const std::vector<Item>& items, const Ray& ray, double step,
                          std::size_t* found) {
  std::vector<bool> inside;
  for (const Item& item : items) inside.push_back(Contains(item.shape, ray.origin_in_world));
  for (double t = step; t < 20; t += step) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      const Vector3d x = ray.origin_in_world + t * ray.direction_in_world;
      if (Contains(items[i].shape, x) == inside[i]) continue;
      *found = i;
      return t;
    }
  }
  return std::numeric_limits<double>::infinity();
}

TEST(FirstHit, AgreesWithMarchingAlongTheRay) {
  constexpr double kStep = 0.002;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  int hits = 0, misses = 0;
  for (int i = 0; i < 400; ++i) {
    const std::vector<Item> items = RandomItems(random);
    const Vector3d origin = 2.5 * Vector3d(normal(random), normal(random), normal(random));
    const Vector3d target(normal(random), normal(random), normal(random));
    const Ray ray{origin, (target - origin).normalized()};
    std::size_t marched_item = 0;
    const double marched = FirstHitByMarching(items, ray, kStep, &marched_item);
    const auto hit = FirstHit(items, ray);
    if (!hit) {
      EXPECT_FALSE(std::isfinite(marched)) << i;
      ++misses;
      continue;
    }
    ++hits;
    // Marching can step over a corner.
    if (marched > hit->distance + kStep) {
      const double middle = hit->distance + kStep / 2;
      EXPECT_FALSE(Contains(hit->item->shape, origin + middle * ray.direction_in_world)) << i;
      continue;
    }
    EXPECT_NEAR(marched, hit->distance, kStep) << i;
    EXPECT_LE((hit->x_in_world - (origin + hit->distance * ray.direction_in_world)).norm(), 1e-12);
    EXPECT_LE(hit->normal_in_world.dot(ray.direction_in_world), 0) << i;
    EXPECT_NEAR(hit->normal_in_world.norm(), 1, 1e-12);
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(misses, 5);
}

TEST(IsBlocked, AgreesWithTheFirstHit) {
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 500; ++i) {
    const std::vector<Item> items = RandomItems(random);
    const Vector3d origin = 3 * Vector3d(normal(random), normal(random), normal(random));
    const Ray ray{origin, Vector3d(normal(random), normal(random), normal(random)).normalized()};
    const auto hit = FirstHit(items, ray);
    EXPECT_EQ(IsBlocked(items, ray), hit.has_value());
    if (!hit) continue;
    EXPECT_TRUE(IsBlocked(items, ray, hit->distance + 1e-3));
    EXPECT_FALSE(IsBlocked(items, ray, hit->distance - 1e-3));
    // A point light on the surface itself is not shadowed by it.
    EXPECT_FALSE(IsBlocked(items, ray, hit->distance));
  }
}

TEST(FirstHit, DoesNotHitTheSurfaceThatTheRayLeaves) {
  const std::vector<Item> items = {{Sphere{{0, 0, 0}, 1}}, {Disc{{0, 0, 3}, 2}}};
  const Ray ray{{0, 0, 1 - 1e-9}, Vector3d::UnitZ()};
  const auto hit = FirstHit(items, ray);
  ASSERT_TRUE(hit.has_value());
  EXPECT_EQ(hit->item, &items[1]);
  EXPECT_NEAR(hit->distance, 2, 1e-6);
  EXPECT_EQ(hit->normal_in_world, -Vector3d::UnitZ());
}

TEST(FirstHit, OfNoShapesIsNone) {
  EXPECT_FALSE(FirstHit(std::vector<Item>{}, {Vector3d::Zero(), Vector3d::UnitX()}));
  EXPECT_FALSE(IsBlocked(std::vector<Item>{}, {Vector3d::Zero(), Vector3d::UnitX()}));
}

}  // namespace
}  // namespace nerf
