#include <malloc.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string_view>

#include "nerf/base/input_error.h"
#include "nerf/commands/commands.h"

namespace {

constexpr int kExitBadInput = 2;
constexpr int kExitInternal = 1;

// Results go to standard output, warnings and errors to standard error.
void SetUpLogging() {
  auto logger = spdlog::stderr_color_st("nerf");
  logger->set_pattern("%^%l%$: %v");
  spdlog::set_default_logger(logger);
}

// Every step frees and allocates the same large blocks. By default glibc returns them to the system
// and gets zeroed pages back, which takes a tenth of the training time.
void KeepFreedMemory() {
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

}  // namespace

int main(int argc, char** argv) {
  SetUpLogging();
  KeepFreedMemory();
  CLI::App app{"nerf: radiance fields from photographs, on an ordinary CPU"};
  app.set_version_flag("--version", NERF_VERSION);
  app.require_subcommand(1);
  app.failure_message([](const CLI::App*, const CLI::Error& e) {
    return fmt::format("error: {}; see --help\n", e.what());
  });
  app.footer("nerf COMMAND --help shows the flags of a command, with examples.");
  try {
    nerf::AddTrainCommand(app);
    nerf::AddSplatCommand(app);
    nerf::AddRenderCommand(app);
    nerf::AddEvalCommand(app);
    nerf::AddPosesCommand(app);
    nerf::AddSampleCommand(app);
    nerf::AddInspectCommand(app);
    nerf::AddSelfcheckCommand(app);
    nerf::AddStudyCommand(app);
    nerf::AddPhotometricStereoCommand(app);
    nerf::AddMaterialsCommand(app);
    nerf::AddRelightCommand(app);
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::RuntimeError& e) {
    return e.get_exit_code();  // a command that ran and failed or was stopped
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : kExitBadInput;
  } catch (const std::filesystem::filesystem_error& e) {
    spdlog::error("{}: {}; choose another path", e.path1().string(), e.code().message());
    return kExitBadInput;
  } catch (const nerf::InputError& e) {
    spdlog::error("{}", e.what());
    return kExitBadInput;
  } catch (const std::exception& e) {
    // LibTorch appends a stack trace after the first line.
    spdlog::critical("{}", std::string_view(e.what()).substr(0, std::strcspn(e.what(), "\n")));
    return kExitInternal;
  }
}
