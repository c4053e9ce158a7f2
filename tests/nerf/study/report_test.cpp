#include "nerf/study/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nerf/image/image_io.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(StudyReport, IsOnePageWithoutExternalResources) {
  const test::ScratchFolder folder;
  WriteImage(folder.path() / "fast-short.png", Image(4, 4, 3));
  nlohmann::json results = {{"input", "photos </script><script>alert(1)"},
                            {"settings", {{{"name", "fast-short"}}, {{"name", "no-picture"}}}}};
  const std::string page = StudyReport(results, folder.path());
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,iVBORw0KGgo"));  // PNG signature
  EXPECT_THAT(page, Not(HasSubstr("alert(1)</script>")));
  EXPECT_THAT(page, Not(HasSubstr("</script><script>alert")));
  for (const char* mark : {"/*STUDY*/", "/*CROPS*/", "/*CHART.JS*/", "src=\"http", "href=\"http"}) {
    EXPECT_THAT(page, Not(HasSubstr(mark)));
  }
  EXPECT_THAT(page, HasSubstr("Chart.js v3"));
}

}  // namespace
}  // namespace nerf
