#include "nerf/model/representation_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nerf/base/atomic_file.h"
#include "nerf/model/run_folder.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using testing::HasSubstr;

TEST(RepresentationRecord, IsReadAsItWasWritten) {
  test::ScratchFolder run;
  EXPECT_FALSE(ReadRepresentation(run.path()).makes_splats);
  RepresentationRecord record;
  record.makes_splats = true;
  record.tried = {20, 21};
  record.field_seconds = 17;
  WriteRepresentation(record, run.path());
  EXPECT_EQ(ReadRepresentation(run.path()).makes_splats, true);
  EXPECT_EQ(ReadRepresentation(run.path()).field_seconds, 17);
  EXPECT_EQ(ReadRepresentation(run.path()).tried->splats, 21);
  EXPECT_EQ(ReadRepresentation(run.path()).Best(), Representation::kField);
  record.reached = {30, 31};
  WriteRepresentation(record, run.path());
  EXPECT_EQ(ReadRepresentation(run.path()).Best(), Representation::kSplats);
  record.reached = {31, 31};
  EXPECT_EQ(record.Best(), Representation::kField);
  WriteFileAtomically(RepresentationPath(run.path()), R"({"tried_psnr": {"field": "x"}})");
  EXPECT_THAT(test::InputErrorOf([&] { ReadRepresentation(run.path()); }),
              HasSubstr("representation.json"));
}

}  // namespace
}  // namespace nerf
