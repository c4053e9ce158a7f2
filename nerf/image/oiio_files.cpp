#include "nerf/image/oiio_files.h"

#include <string>

namespace nerf {
namespace {

bool HasQuestionMark(const std::filesystem::path& file) {
  return file.native().find('?') != std::string::npos;
}

// By the extension alone, from which OpenImageIO finds the format.
std::string FormatName(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  return extension.empty() ? extension : extension.substr(1);
}

}  // namespace

std::unique_ptr<OIIO::ImageInput> OpenImageInput(const std::filesystem::path& file,
                                                 const OIIO::ImageSpec* config) {
  if (!HasQuestionMark(file)) return OIIO::ImageInput::open(file.string(), config);
  auto input = OIIO::ImageInput::create(FormatName(file));
  OIIO::ImageSpec spec;
  if (!input || !input->open(file.string(), spec, config ? *config : OIIO::ImageSpec())) {
    return nullptr;
  }
  return input;
}

std::unique_ptr<OIIO::ImageOutput> CreateImageOutput(const std::filesystem::path& file) {
  return OIIO::ImageOutput::create(HasQuestionMark(file) ? FormatName(file) : file.string());
}

int OrientationOf(const OIIO::ImageSpec& spec) {
  const int orientation = spec.get_int_attribute("Orientation", 1);
  return orientation >= 1 && orientation <= 8 ? orientation : 1;
}

}  // namespace nerf
