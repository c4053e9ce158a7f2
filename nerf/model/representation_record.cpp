#include "nerf/model/representation_record.h"

#include <nlohmann/json.hpp>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/model/run_folder.h"

namespace nerf {
namespace {

nlohmann::json JsonOf(const ComparedPsnr& psnr) {
  return {{"field", psnr.field}, {"splats", psnr.splats}};
}

std::optional<ComparedPsnr> PsnrOf(const nlohmann::json& record, const char* key) {
  if (!record.contains(key)) return std::nullopt;
  return ComparedPsnr{record[key].at("field"), record[key].at("splats")};
}

}  // namespace

Representation RepresentationRecord::Best() const {
  const bool splats = reached ? reached->splats > reached->field : splats_stand;
  return splats ? Representation::kSplats : Representation::kField;
}

void RepresentationRecord::ForgetReached() {
  reached.reset();
  splats_stand = false;
}

RepresentationRecord ReadRepresentation(const std::filesystem::path& run) {
  const std::filesystem::path file = RepresentationPath(run);
  RepresentationRecord record;
  if (!std::filesystem::exists(file)) return record;
  try {
    const nlohmann::json stored = nlohmann::json::parse(ReadWholeFile(file));
    if (stored.contains("makes_splats")) record.makes_splats = stored["makes_splats"].get<bool>();
    record.tried = PsnrOf(stored, "tried_psnr");
    record.reached = PsnrOf(stored, "reached_psnr");
    record.field_seconds = stored.value("field_seconds", 0.0);
    record.field_steps = stored.value("field_steps", std::int64_t{-1});
    record.splats_stand = stored.value("splats_stand", false);
  } catch (const nlohmann::json::exception& error) {
    throw InputError("{}: {}; delete it, and choose with --with field or --with splats",
                     file.string(), error.what());
  }
  return record;
}

void WriteRepresentation(const RepresentationRecord& record, const std::filesystem::path& run) {
  nlohmann::json stored = nlohmann::json::object();
  if (record.makes_splats) stored["makes_splats"] = *record.makes_splats;
  if (record.tried) stored["tried_psnr"] = JsonOf(*record.tried);
  if (record.reached) stored["reached_psnr"] = JsonOf(*record.reached);
  if (record.field_seconds > 0) stored["field_seconds"] = record.field_seconds;
  if (record.field_steps >= 0) stored["field_steps"] = record.field_steps;
  if (record.splats_stand) stored["splats_stand"] = true;
  stored["best"] = record.Best() == Representation::kSplats ? "splats" : "field";
  WriteFileAtomically(RepresentationPath(run), stored.dump(2) + "\n");
}

}  // namespace nerf
