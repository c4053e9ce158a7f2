#pragma once

#include "nerf/model/model.h"
#include "nerf/scene/dataset.h"
#include "nerf/synthetic/capture.h"

namespace nerf::test {

// A capture of the built-in scene in memory, with every 8th view held out.
struct SmallCapture {
  synthetic::Capture capture;
  Dataset data;
  SceneFacts scene;
};
SmallCapture MakeSmallCapture(int views, int width, int height);

// A configuration that trains in seconds.
Config SmallConfig();

}  // namespace nerf::test
