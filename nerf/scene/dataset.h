#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nerf/image/image.h"
#include "nerf/image/mask.h"
#include "nerf/scene/photograph.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

struct DataOptions {
  int downscale = 1;          // area-average photographs by this factor
  int test_every = 8;         // hold out images 0, 8, 16, ... by name; 0 holds out none
  int validation_images = 1;  // taken out of the training images to watch the progress; 0: none
  int memory_mb = 1024;       // for pixels; where they do not fit, an even random share is held

  void Check() const;
};

// Marks each image as train, validation or test, in place. A split that the source defines is kept;
// otherwise images are counted in the order of their names. With fewer than 8 images none is held
// out; with fewer than 16 left for training there is no validation split.
void AssignSplits(PosedImages& posed, const DataOptions& options);

// What training will hold, known before a photograph is read.
struct DataPlan {
  std::int64_t train = 0, validation = 0, held_out = 0;  // images
  std::int64_t pixels = 0;                               // to train on and to validate, downscaled
  std::int64_t held = 0;                                 // of them, within DataOptions::memory_mb

  std::int64_t Bytes() const;
  // Of the pixels of one photograph, at least one.
  std::int64_t HeldOf(std::int64_t pixels_of_photo) const;
};
DataPlan PlanData(const PosedImages& posed, const DataOptions& options);

// A point whose distance is known, as a photograph sees it.
struct SeenPoint {
  std::int64_t pixel = 0;  // y * width + x
  float distance = 0;      // from the camera's centre, normalized units
};

// A photograph in memory, downscaled; RGBA as 16-bit floats: what training reads. Training draws a
// few million pixels in all, so of photographs that do not fit a random share is as good: one pixel
// of each of `held` stretches of equal length, row after row.
struct View {
  std::string name;
  Camera camera;                             // of the downscaled image
  Eigen::Isometry3d normalized_from_camera;  // OpenCV axes
  std::int64_t lens = 0;                     // which camera of the input took it
  std::vector<Eigen::half> rgba;             // [held,4], straight alpha
  std::uint64_t seed = 0;                    // of the choice
  std::vector<std::uint32_t> whole;          // pixels to choose from, rising; empty: all
  std::vector<SeenPoint> points;             // where distances are to be learned from

  std::int64_t Held() const { return static_cast<std::int64_t>(rgba.size() / 4); }
  // Where the held pixel k stands: y * width + x.
  std::int64_t PixelOf(std::int64_t k) const;
  // The held pixel that stands at a place or near it.
  std::int64_t HeldNear(std::int64_t pixel) const;

 private:
  std::int64_t Choices() const;
  bool ShowsAll() const { return whole.empty(); }
};

struct Dataset {
  std::vector<View> train;
  std::vector<View> validation;
  ColorEncoding encoding = ColorEncoding::kSrgb;
  bool has_alpha = false;            // some pixel is not opaque
  int made_linear = 0;               // display-referred photographs among linear ones
  std::vector<std::string> skipped;  // photographs that could not be read, with the reason
};

// Reads the training and validation photographs on all threads, or on as many as can decode at once
// within that much memory again, at least one. A photograph that cannot be read is
// named in `skipped` and left out. Where some are linear (EXR, HDR), all are made so. Throws
// InputError when none is left to train on.
// Pixels that a mask says to ignore are not held, and never drawn, nor are those of made-linear
// photographs that are white.
Dataset LoadDataset(const PosedImages& posed, const DataOptions& options,
                    std::optional<MaskMeaning> masks,
                    const SceneNormalization& normalized_from_world);

// What is seen through transparent pixels wherever a picture is made: white where photographs have
// alpha (the NeRF-synthetic protocol), black elsewhere.
Eigen::Vector3f DisplayBackground(bool has_alpha);

}  // namespace nerf
