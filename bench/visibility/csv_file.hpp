#pragma once

#include <fmt/os.h>

#include <string>
#include <utility>
#include <vector>

namespace fluxel::bench {

using TextColumns = std::vector<std::pair<const char*, std::string>>;
using NumberColumns = std::vector<std::pair<const char*, double>>;

/// A table whose lines all have the same columns. Every line is written at once, so that a run that is
/// stopped leaves what it has.
class CsvFile {
 public:
  explicit CsvFile(const std::string& name) : file_(fmt::output_file(name)) {}

  void add(const TextColumns& texts, const NumberColumns& numbers) {
    if (!has_heads_) {
      for (const auto& column : texts) separate(column.first, &column == texts.data());
      for (const auto& column : numbers) separate(column.first, false);
      file_.print("\n");
      has_heads_ = true;
    }
    for (const auto& column : texts) separate(column.second, &column == texts.data());
    for (const auto& column : numbers) separate(fmt::format("{:.9g}", column.second), false);
    file_.print("\n");
    file_.flush();
  }

 private:
  void separate(const std::string& text, bool first) { file_.print("{}{}", first ? "" : ",", text); }

  fmt::ostream file_;
  bool has_heads_ = false;
};

}  // namespace fluxel::bench
