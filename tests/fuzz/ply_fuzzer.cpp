#include "nerf/base/ply_vertices.h"
#include "tests/fuzz/fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = nerf::fuzz::WriteFile("scene.ply", {reinterpret_cast<const char*>(data), size});
  nerf::fuzz::Expect([&] {
    const nerf::PlyVertices vertices(file);
    for (const std::int64_t i : {std::int64_t{0}, vertices.Count() - 1}) {
      for (const nerf::PlyProperty& property : vertices.Properties()) vertices.At(i, property);
    }
  });
  return 0;
}
