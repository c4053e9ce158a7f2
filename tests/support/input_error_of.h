#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "nerf/base/input_error.h"

namespace nerf::test {

// The message of the InputError that a call throws, or "no error". Other exceptions, and messages
// of several lines, fail the test.
template <class Call>
std::string InputErrorOf(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an InputError: " << error.what();
  }
  return "no error";
}

}  // namespace nerf::test
