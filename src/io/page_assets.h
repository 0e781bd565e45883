#pragma once

#include <string_view>

namespace sumogamma {

// Files of src/io, embedded by cmake/embed.cmake: CMakeLists.txt says which.
extern const std::string_view kReplayPageHtml;
extern const std::string_view kReplayPageCss;
extern const std::string_view kReplayPageJs;
extern const std::string_view kReportPageHtml;
extern const std::string_view kStudyPageHtml;

}  // namespace sumogamma
