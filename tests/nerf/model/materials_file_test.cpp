#include "nerf/model/materials_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nerf/geometry/surface_mesh.h"
#include "nerf/model/checkpoint.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

Materials SmallMaterials() {
  Materials materials;
  materials.options.directions = 64;
  materials.resolution = 20;
  materials.steps = 7;
  materials.field_step = 11;
  RelightableSurface& surface = materials.surface;
  surface.distance.cell = 0.1;
  surface.distance.origin = {-0.5, -0.6, -0.7};
  surface.distance.size = {11, 13, 15};
  for (int z = 0; z < 15; ++z) {
    for (int y = 0; y < 13; ++y) {
      for (int x = 0; x < 11; ++x) {
        surface.distance.values.push_back(
            static_cast<float>(surface.distance.PositionOf(x, y, z).norm() - 0.4));
      }
    }
  }
  surface.mesh = SurfaceMesh(surface.distance);
  surface.field = std::make_shared<MaterialField>(
      Eigen::AlignedBox3d(Eigen::Vector3d(-1, -1, -2), Eigen::Vector3d(1, 1, 1)), 20, false, 5);
  surface.normal_offset = materials.options.normal_offset;
  surface.lights = {{"noon", torch::rand({64, 3}), {PointLight{{1, 2, 3}, {4, 5, 6}}}}};
  return materials;
}

TEST(MaterialsFile, IsReadAsItWasWritten) {
  const test::ScratchFolder folder;
  const auto file = folder.path() / "materials.nerf";
  const Materials written = SmallMaterials();
  WriteMaterials(written, file);
  const Materials read = ReadMaterials(file);
  EXPECT_EQ(read.steps, 7);
  EXPECT_EQ(read.field_step, 11);
  EXPECT_EQ(read.options.directions, 64);
  EXPECT_EQ(read.surface.distance.values, written.surface.distance.values);
  EXPECT_EQ(read.surface.distance.size, written.surface.distance.size);
  EXPECT_EQ(read.surface.mesh.vertices, written.surface.mesh.vertices);
  EXPECT_EQ(read.surface.mesh.faces, written.surface.mesh.faces);
  ASSERT_EQ(read.surface.lights.size(), 1u);
  const LightGroup& light = read.surface.lights[0];
  EXPECT_EQ(light.name, "noon");
  EXPECT_TRUE(torch::equal(light.environment, written.surface.lights[0].environment));
  ASSERT_EQ(light.lamps.size(), 1u);
  EXPECT_EQ(std::get<PointLight>(light.lamps[0]).x_in_world, Eigen::Vector3d(1, 2, 3));
  const torch::Tensor position = torch::rand({10, 3});
  EXPECT_TRUE(torch::equal(read.surface.field->forward(position).material.base_color,
                           written.surface.field->forward(position).material.base_color));
}

TEST(MaterialsFile, WhatIsMissingOrDamagedIsNamed) {
  const test::ScratchFolder folder;
  const auto file = folder.path() / "materials.nerf";
  EXPECT_THAT(test::InputErrorOf([&] { ReadMaterials(file); }),
              testing::HasSubstr("nerf materials"));
  WriteMaterials(SmallMaterials(), file);
  const Checkpoint checkpoint = ReadCheckpoint(file);
  const auto is_refused = [&](const Checkpoint& damaged) {
    WriteCheckpoint(file, damaged);
    const std::string error = test::InputErrorOf([&] { ReadMaterials(file); });
    EXPECT_THAT(error, testing::HasSubstr(file.string()));
    EXPECT_EQ(error.find('\n'), std::string::npos);
  };
  Checkpoint damaged = checkpoint;
  damaged.tensors.erase("light");
  is_refused(damaged);
  damaged = checkpoint;
  damaged.tensors["distance"] = torch::zeros({1, 4, 4});
  is_refused(damaged);
  damaged = checkpoint;
  damaged.meta["grid"]["cell"] = -1;
  is_refused(damaged);
  damaged = checkpoint;
  damaged.meta["options"]["directions"] = 1 << 30;
  is_refused(damaged);
  damaged = checkpoint;
  damaged.meta.erase("box");
  is_refused(damaged);
}

}  // namespace
}  // namespace nerf
