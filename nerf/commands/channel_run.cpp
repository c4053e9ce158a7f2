#include "nerf/commands/channel_run.h"

#include <spdlog/fmt/fmt.h>

#include "nerf/base/progress.h"
#include "nerf/commands/relit_pictures.h"
#include "nerf/image/image_io.h"
#include "nerf/model/materials_file.h"
#include "nerf/relight/environment_light.h"

namespace nerf {

void AddChannelOptions(CLI::App& command, ChannelOptions& options) {
  auto* channel =
      command
          .add_option("--channel", options.channels,
                      "of a run with materials, instead of its picture; several with commas")
          ->delimiter(',')
          ->check(CLI::IsMember(ChannelNames()));
  command.add_option("--edit", options.edit, "with --channel: a JSON file that changes materials")
      ->needs(channel);
}

void RenderChannels(const OpenedRun& run, const std::filesystem::path& folder_of_run,
                    const ChannelOptions& options, const ShotList& list,
                    const std::filesystem::path& output) {
  constexpr int kBounces = 2, kMapHeight = 64;
  const SceneFacts& scene = run.model->Scene();
  const SceneNormalization& frame = scene.normalized_from_world;
  Materials materials = ReadMaterials(MaterialsPath(folder_of_run));
  RelightableSurface& surface = materials.surface;
  if (!options.edit.empty()) {
    surface.edits = ReadMaterialEdits(options.edit, frame, surface.mesh.vertices);
  }
  Relighter relighter(surface);
  relighter.SetLight(surface.lights.front(), kBounces);
  const EnvironmentMap map(EnvironmentImage(surface.lights.front().environment, kMapHeight,
                                            MapFromFrame(frame.rotation)),
                           "the light of the run");
  const RelitBackground light{&map, MapFromFrame(frame.rotation)};
  ProgressLine progress("rendering", static_cast<std::int64_t>(list.shots.size()));
  std::int64_t done = 0;
  for (const Shot& shot : list.shots) {
    const LookedAt view = LookAt(run, relighter, shot);
    const RelitPixels relit = relighter.Reflect(view.seen);
    for (const std::string& name : options.channels) {
      const ChannelImage channel = ChannelOf(name, view, relit, light, scene);
      const std::string stem = (output / (shot.name + "_" + name)).string();
      WriteImage(stem + ".png", channel.display);
      WriteImage(stem + ".exr", channel.linear);
    }
    progress.Update(++done, shot.name);
  }
  progress.Finish();
}

}  // namespace nerf
