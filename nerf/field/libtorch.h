#pragma once

// What of LibTorch is used here. <torch/torch.h> brings all layers, optimisers and readers of data,
// whose templates cost 7 seconds in each file that includes it, precompiled or not.
#include <torch/autograd.h>
#include <torch/nn/module.h>
#include <torch/types.h>
#include <torch/utils.h>
