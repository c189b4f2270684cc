// A report as a file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/page_files.hpp"
#include "report/report_data.hpp"

namespace glocal::app {

struct ReportOptions {
  std::vector<std::string> folders = {};  ///< Of results, or that hold some.
  std::string out = "report.html";
  std::string baseline = {};  ///< Name of a run; empty: the first.
  ReportLimits limits = {};
  PageFileOptions files = {};
};

/// Writes the page as write_page() does, and says where it is. Throws ConfigError for folders without
/// results, and a file that is in the way.
std::filesystem::path write_report(const ReportOptions& options);

}  // namespace glocal::app
