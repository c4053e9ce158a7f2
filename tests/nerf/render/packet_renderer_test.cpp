#include "nerf/render/packet_renderer.h"

#include <gmock/gmock.h>

#include "nerf/base/input_error.h"
#include "nerf/base/stopwatch.h"
#include "nerf/render/image_renderer.h"
#include "tests/support/simd_levels.h"
#include "tests/support/two_engines.h"

namespace nerf {
namespace {

using test::TwoEngines;

RenderOutput RenderWith(const TwoEngines& e, const RenderQuality& quality) {
  return PacketRenderer(*e.parts, quality).Render(e.batch.rays);
}

RenderQuality Exact(const TwoEngines& e) {
  return RenderQuality::Of(1, e.march, e.proposal_options);
}

class PacketRendererAtEveryLevel : public test::EverySimdLevel {};

TEST_P(PacketRendererAtEveryLevel, EqualsTheEngineWithoutApproximations) {
  for (const bool with_proposal : {false, true}) {
    TwoEngines e;
    e.march.stop_transmittance = 1e-6;
    e.Make(300, with_proposal);
    SCOPED_TRACE(with_proposal);
    const RenderOutput expected = e.fused->Render(e.batch.rays), out = RenderWith(e, Exact(e));
    for (std::size_t i = 0; i < expected.rgb.size(); ++i) {
      EXPECT_NEAR(out.rgb[i], expected.rgb[i], 1e-5);
    }
    for (std::size_t r = 0; r < expected.opacity.size(); ++r) {
      EXPECT_NEAR(out.opacity[r], expected.opacity[r], 1e-5);
      EXPECT_NEAR(out.depth[r], expected.depth[r], 1e-4 * (1 + expected.depth[r]));
    }
    EXPECT_GT(out.samples, 0);
    EXPECT_LE(out.samples, expected.samples);
  }
}

NERF_FOR_EVERY_SIMD_LEVEL(PacketRendererAtEveryLevel);

TEST(PacketRenderer, StoppingEarlyChangesNoPixelByMoreThanItsBound) {
  TwoEngines e;
  e.march.stop_transmittance = 1e-6;
  e.Make(300);
  const RenderOutput exact = RenderWith(e, Exact(e));
  RenderQuality quality = Exact(e);
  quality.stop_transmittance = 0.2;
  const RenderOutput out = RenderWith(e, quality);
  EXPECT_LT(out.samples, exact.samples);
  double largest = 0;
  for (std::size_t i = 0; i < exact.rgb.size(); ++i) {
    largest = std::max(largest, std::fabs(static_cast<double>(out.rgb[i] - exact.rgb[i])));
  }
  EXPECT_LE(largest, quality.stop_transmittance);
  EXPECT_GT(largest, 1e-4);  // rays did stop early
}

// However small the weight of each sample, its colour is not lost, but represented by fewer ones.
TEST(PacketRenderer, ThinFogKeepsItsColourAndOpacity) {
  TwoEngines e;
  e.Make(40);
  const torch::NoGradGuard no_grad;
  for (auto& p : e.field->named_parameters()) {
    if (p.key().find("color") != std::string::npos) p.value().zero_();  // grey: sigmoid(0)
    if (p.key().ends_with("table")) p.value().fill_(0.01);              // fog
  }
  RenderQuality quality = Exact(e);
  const RenderOutput exact = RenderWith(e, quality);
  for (const double share : {0.02, 0.25, 2.5}) {  // many times the weight of a sample, of a ray
    quality.color_share = share;
    const RenderOutput out = RenderWith(e, quality);
    EXPECT_EQ(out.opacity, exact.opacity);
    EXPECT_EQ(out.depth, exact.depth);
    for (std::size_t i = 0; i < exact.rgb.size(); ++i) {
      ASSERT_GT(exact.opacity[i / 3], 0);
      ASSERT_LT(exact.opacity[i / 3], 0.99);
      EXPECT_NEAR(out.rgb[i], exact.rgb[i], 1e-6);
    }
  }
}

// The colour of a share of weight is that of its middle, so smooth changes of colour have no bias.
TEST(PacketRenderer, FewerColoursDoNotBiasTowardsTheBack) {
  TwoEngines e;
  e.march.steps_per_unit = 200;
  e.Make(200);
  RenderQuality quality = Exact(e);
  const RenderOutput exact = RenderWith(e, quality);
  quality.color_share = 0.1;
  const RenderOutput out = RenderWith(e, quality);
  double sum = 0, largest = 0;
  for (std::size_t i = 0; i < exact.rgb.size(); ++i) {
    const double error = static_cast<double>(out.rgb[i]) - static_cast<double>(exact.rgb[i]);
    sum += error;
    largest = std::max(largest, std::fabs(error));
  }
  EXPECT_GT(largest, 1e-4);
  EXPECT_LT(largest, 0.2);
  EXPECT_LT(std::fabs(sum) / static_cast<double>(exact.rgb.size()), 0.005);
}

TEST(PacketRenderer, APacketOfEqualRaysEqualsSingleRays) {
  TwoEngines e;
  e.Make(64, /*with_proposal=*/true);
  RayBatch& rays = e.batch.rays;
  for (std::int64_t r = 0; r < 64; ++r) {
    const std::int64_t from = r / 16 * 16;
    rays.jitter[r] = rays.jitter[from];
    for (int c = 0; c < 3; ++c) {
      rays.origin[3 * r + c] = rays.origin[3 * from + c];
      rays.direction[3 * r + c] = rays.direction[3 * from + c];
    }
  }
  RenderQuality quality = Exact(e);
  const RenderOutput alone = RenderWith(e, quality);
  for (const int packet : {4, 16}) {
    quality.packet = packet;
    const RenderOutput together = RenderWith(e, quality);
    for (std::size_t i = 0; i < alone.rgb.size(); ++i) {
      EXPECT_NEAR(together.rgb[i], alone.rgb[i], 2e-3);
    }
  }
}

// The mean ray of a packet may miss a surface that one of its rays hits: that ray gets samples of
// its own.
TEST(PacketRenderer, RaysWithMissedSurfacesGetSamplesOfTheirOwn) {
  TwoEngines e;
  e.Make(64, /*with_proposal=*/true);  // rays in all directions: no neighbours at all
  RenderQuality quality = Exact(e);
  const RenderOutput alone = RenderWith(e, quality);
  quality.packet = 16;
  const RenderOutput together = RenderWith(e, quality);
  int missed = 0;
  for (std::size_t r = 0; r < alone.opacity.size(); ++r) {
    if (together.opacity[r] >= 0.9f) continue;
    ++missed;
    EXPECT_NEAR(together.opacity[r], alone.opacity[r], 1e-5);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(together.rgb[3 * r + c], alone.rgb[3 * r + c], 1e-5);
  }
  EXPECT_GT(missed, 0);
  EXPECT_GT(together.samples, alone.samples);  // some rays were evaluated twice
}

TEST(PacketRenderer, TheLastPacketMayBeIncomplete) {
  TwoEngines e;
  e.Make(21, /*with_proposal=*/true);
  RenderQuality quality = Exact(e);
  quality.packet = 16;
  quality.samples = 5;
  for (const float value : RenderWith(e, quality).rgb) EXPECT_TRUE(std::isfinite(value));
}

TEST(PacketRenderer, DoesNotHideNaN) {
  TwoEngines e;
  e.Make(8);
  const torch::NoGradGuard no_grad;
  for (auto& p : e.field->named_parameters()) p.value().fill_(std::nanf(""));
  RenderQuality quality = RenderQuality::Of(0.3, e.march, e.proposal_options);
  for (const float value : RenderWith(e, quality).rgb) EXPECT_TRUE(std::isnan(value));
}

TEST(PacketRenderer, TimedStagesSumToAtMostTheWholeTime) {
  TwoEngines e;
  e.Make(600, true);
  const PacketRenderer renderer(*e.parts, Exact(e));
  const Stopwatch watch;
  const StageSeconds stages = renderer.Render(e.batch.rays).seconds;
  EXPECT_LE(stages.Sum(), watch.Seconds());
  for (const double seconds :
       {stages.sampling, stages.encoding, stages.networks, stages.compositing}) {
    EXPECT_GT(seconds, 0);
  }
}

TEST(RenderQuality, GoesFromFastToExact) {
  const MarchOptions march;
  const ProposalOptions proposal;
  RenderQuality before = RenderQuality::Of(0, march, proposal);
  EXPECT_EQ(before.packet, 16);
  for (const double quality : {0.1, 0.3, 0.5, 0.7, 0.9, 1.0}) {
    const RenderQuality q = RenderQuality::Of(quality, march, proposal);
    EXPECT_LE(q.packet, before.packet);
    EXPECT_GE(q.samples, before.samples);
    EXPECT_LT(q.color_share, before.color_share);
    EXPECT_LT(q.stop_transmittance, before.stop_transmittance);
    before = q;
  }
  EXPECT_EQ(before.packet, 1);
  EXPECT_EQ(before.samples, proposal.samples);
  EXPECT_EQ(before.color_share, 0);
  EXPECT_EQ(before.stop_transmittance, march.stop_transmittance);
  EXPECT_THROW(RenderQuality::Of(1.1, march, proposal), InputError);
  EXPECT_THROW(RenderQuality::Of(std::nan(""), march, proposal), InputError);
}

// Renders each ray's direction as its colour, and records the rays in their order.
class DirectionRenderer : public RayRenderer {
 public:
  RenderOutput Render(const RayBatch& rays) const override {
    RenderOutput out;
    out.rgb = rays.direction;
    out.opacity.assign(rays.Size(), 1);
    out.depth.assign(rays.Size(), 1);
    directions.insert(directions.end(), rays.direction.begin(), rays.direction.end());
    return out;
  }
  mutable std::vector<float> directions;
};

TEST(RenderView, RendersEachPixelByItsRayAndNeighboursTogether) {
  for (const auto& [width, height] : {std::pair{4, 4}, {7, 5}, {1, 1}, {70, 41}}) {
    Camera camera;
    camera.width = width;
    camera.height = height;
    camera.params = {100, 100, width / 2.0, height / 2.0, 0, 0, 0, 0};
    camera.model = CameraModel::kOpenCV;
    DirectionRenderer renderer;
    std::int64_t done = 0;
    const RenderedView view =
        RenderView(renderer, camera, Eigen::Isometry3d::Identity(), Eigen::Vector3f::Zero(),
                   ColorEncoding::kLinear, [&](std::int64_t pixels) {
                     EXPECT_GE(pixels, done);
                     done = pixels;
                   });
    EXPECT_EQ(done, width * height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Eigen::Vector3d d =
            Eigen::Vector3d((x + 0.5 - width / 2.0) / 100, (y + 0.5 - height / 2.0) / 100, 1)
                .normalized();
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(view.rgb.pixels[3 * (y * width + x) + c], d[c], 1e-6) << x << "," << y;
        }
      }
    }
    ASSERT_EQ(renderer.directions.size() % 48, 0u);
    for (std::size_t r = 0; r < renderer.directions.size() / 3; ++r) {
      for (const std::size_t packet : {4, 16}) {
        const std::size_t first = r / packet * packet;
        const float across = renderer.directions[3 * r] - renderer.directions[3 * first];
        EXPECT_LE(std::fabs(across), 0.0101 * (packet == 4 ? 1 : 3));
      }
    }
  }
}

TEST(RenderView, PixelsOutsideTheFieldOfViewUseTheRayOfANeighbour) {
  Camera camera;
  camera.model = CameraModel::kOpenCV;
  camera.width = camera.height = 200;
  camera.params = {100, 100, 100, 100, -0.3, 0, 0, 0};  // ends 71 pixels from the centre
  DirectionRenderer renderer;
  const RenderedView view = RenderView(renderer, camera, Eigen::Isometry3d::Identity(),
                                       Eigen::Vector3f(1, 0, 0), ColorEncoding::kLinear);
  EXPECT_EQ(view.opacity.pixels[0], 0);
  EXPECT_EQ(view.rgb.pixels[0], 1);
  EXPECT_EQ(view.opacity.pixels[100 * 200 + 100], 1);
  for (std::size_t r = 0; r < renderer.directions.size() / 3; ++r) {
    const Eigen::Vector3f d(&renderer.directions[3 * r]);
    const Eigen::Vector3f first(&renderer.directions[3 * (r / 16 * 16)]);
    ASSERT_LT((d - first).norm(), 0.3f);
  }
}

TEST(RenderPreview, ShowsTheWholePictureFromFewRays) {
  Camera camera;
  camera.width = 21;
  camera.height = 13;
  camera.params = {100, 100, 10.5, 6.5};
  DirectionRenderer renderer;
  const Image image = RenderPreview(renderer, camera, 4, Eigen::Isometry3d::Identity(),
                                    Eigen::Vector3f::Zero(), ColorEncoding::kLinear);
  EXPECT_EQ(image.width, 21);
  EXPECT_EQ(image.height, 13);
  EXPECT_LT(renderer.directions.size() / 3, 21u * 13u / 4u);
  // The centre of the first block of 4 x 4 pixels.
  const Eigen::Vector3d d = Eigen::Vector3d((2 - 10.5) / 100, (2 - 6.5) / 100, 1).normalized();
  for (int pixel : {0, 3, 21, 3 * 21 + 3}) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixels[3 * pixel + c], d[c], 1e-6);
  }
  EXPECT_NE(image.pixels[3 * 4], image.pixels[0]);
  for (const float value : image.pixels) EXPECT_TRUE(std::isfinite(value));
  RenderPreview(renderer, camera, 100, Eigen::Isometry3d::Identity(), Eigen::Vector3f::Zero(),
                ColorEncoding::kLinear);  // larger than the picture
}

}  // namespace
}  // namespace nerf
