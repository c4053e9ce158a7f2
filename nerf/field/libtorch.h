#pragma once

// The parts of LibTorch in use. <torch/torch.h> includes all layers, optimisers and data loaders,
// whose templates cost 7 seconds per including file, precompiled or not.
#include <torch/autograd.h>
#include <torch/nn/module.h>
#include <torch/types.h>
#include <torch/utils.h>
