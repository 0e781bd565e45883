#pragma once

#include <string_view>

namespace sumogamma {

// The files of src/io by these names, embedded by cmake/embed.cmake.
extern const std::string_view kReplayPageHtml;
extern const std::string_view kReplayPageCss;
extern const std::string_view kReplayPageJs;
extern const std::string_view kReportPageHtml;

}  // namespace sumogamma
