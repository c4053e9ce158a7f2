#pragma once

namespace CLI {
class App;
}

namespace nerf {

// Each adds one subcommand with its flags and examples to the program; what the command does runs
// as its callback.
void AddSampleCommand(CLI::App& app);
void AddPosesCommand(CLI::App& app);
void AddPhotometricStereoCommand(CLI::App& app);
void AddRelightCommand(CLI::App& app);
void AddTrainCommand(CLI::App& app);
void AddRenderCommand(CLI::App& app);
void AddEvalCommand(CLI::App& app);
void AddSelfcheckCommand(CLI::App& app);
void AddStudyCommand(CLI::App& app);
void AddInspectCommand(CLI::App& app);

}  // namespace nerf
