# Writes OUTPUT: a C++ file with the text of TEMPLATE and of the JavaScript library CHART_JS.
file(READ ${TEMPLATE} page)
file(READ ${CHART_JS} chart)
string(REGEX REPLACE "//# sourceMappingURL=[^\n]*" "" chart "${chart}")
set(text "// Made by embed_report.cmake.\n#include \"nerf/study/report.h\"\n\nnamespace nerf {\n\n")
string(APPEND text "std::string_view ReportTemplate() {\n  return R\"EMBED(${page})EMBED\";\n}\n\n")
string(APPEND text "std::string_view ChartLibrary() {\n  return R\"EMBED(${chart})EMBED\";\n}\n\n}  // namespace nerf\n")
file(WRITE ${OUTPUT} "${text}")
