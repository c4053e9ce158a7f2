#pragma once

namespace CLI {
class App;
}

namespace nerf {

// Each adds a subcommand with its flags, its examples, and a callback that runs it.
void AddSampleCommand(CLI::App& app);
void AddPosesCommand(CLI::App& app);
void AddPhotometricStereoCommand(CLI::App& app);
void AddMaterialsCommand(CLI::App& app);
void AddRelightCommand(CLI::App& app);
void AddTrainCommand(CLI::App& app);
void AddSplatCommand(CLI::App& app);
void AddRenderCommand(CLI::App& app);
void AddEvalCommand(CLI::App& app);
void AddSelfcheckCommand(CLI::App& app);
void AddStudyCommand(CLI::App& app);
void AddInspectCommand(CLI::App& app);

}  // namespace nerf
