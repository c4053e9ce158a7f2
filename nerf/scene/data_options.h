#pragma once

namespace nerf {

// Which photographs are trained on, and how they are read.
struct DataOptions {
  int downscale = 1;          // factor by which photographs are reduced (area average)
  int test_every = 8;         // hold out images 0, 8, 16, ... in order of name; 0 holds out none
  int validation_images = 1;  // taken from the training images to monitor progress; 0: none
  int memory_mb = 1024;       // MiB for pixels; larger captures are subsampled at random

  // Throws InputError that names the key and its valid values.
  void Check() const;
};

}  // namespace nerf
