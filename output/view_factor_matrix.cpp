#include "output/view_factor_matrix.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/file.hpp"
#include "output/csv.hpp"
#include "output/numpy_file.hpp"
#include "output/zip_file.hpp"

namespace fluxel {

namespace {

template <class Number>
std::string_view bytes_of(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

template <class Number>
void add_array(ZipFile& archive, std::string_view name, std::string_view type,
               const std::vector<Number>& numbers) {
  archive.begin(name);
  archive.append(numpy_header(type, {numbers.size()}));
  archive.append(bytes_of(numbers));
}

/// One number of each factor.
template <class Number>
void add_entries(ZipFile& archive, std::string_view name, std::string_view type, const ExchangeTable& table,
                 std::size_t count, const std::function<Number(const SurfaceViewFactor&)>& number) {
  archive.begin(name);
  archive.append(numpy_header(type, {count}));
  std::vector<Number> of_row;
  visit_rows(table, [&](std::span<const SurfaceViewFactor> row) {
    of_row.clear();
    for (const SurfaceViewFactor& factor : row) of_row.push_back(number(factor));
    archive.append(bytes_of(of_row));
  });
}

/// `type`: of Index, as NumPy writes it.
template <class Index>
void add_places(ZipFile& archive, const ExchangeTable& table, std::span<const std::uint32_t> row_of,
                std::size_t rows, std::size_t count, std::string_view type) {
  std::vector<Index> ends(rows + 1, 0);
  for (const SurfaceExchange& entry : table.exchanges) {
    ++ends[row_of[entry.from] + 1];
    if (entry.from != entry.to) ++ends[row_of[entry.to] + 1];
  }
  for (std::size_t row = 0; row < rows; ++row) ends[row + 1] += ends[row];
  add_array(archive, "indptr.npy", type, ends);
  add_entries<Index>(archive, "indices.npy", type, table, count,
                     [&](const SurfaceViewFactor& factor) { return static_cast<Index>(row_of[factor.to]); });
}

}  // namespace

void write_view_factor_matrix(const std::filesystem::path& file, const ExchangeTable& table) {
  std::vector<std::uint32_t> row_of(table.areas.size(), 0);
  std::vector<double> areas;
  for (std::size_t surface = 0; surface < table.areas.size(); ++surface) {
    row_of[surface] = static_cast<std::uint32_t>(areas.size());
    if (table.areas[surface] > 0) areas.push_back(table.areas[surface]);
  }
  const std::size_t rows = areas.size(), count = count_view_factors(table.exchanges);
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    ZipFile archive(temporary);
    archive.begin("format.npy");
    archive.append(numpy_header("'|S3'", {}));
    archive.append("csr");
    add_array(archive, "shape.npy", "'<i8'", std::vector<std::int64_t>(2, static_cast<std::int64_t>(rows)));
    add_array(archive, "area_m2.npy", "'<f8'", areas);
    if (count <= std::numeric_limits<std::int32_t>::max())
      add_places<std::int32_t>(archive, table, row_of, rows, count, "'<i4'");
    else
      add_places<std::int64_t>(archive, table, row_of, rows, count, "'<i8'");
    add_entries<double>(archive, "data.npy", "'<f8'", table, count,
                        [](const SurfaceViewFactor& factor) { return factor.value; });
    add_entries<float>(archive, "error_estimate.npy", "'<f4'", table, count,
                       [](const SurfaceViewFactor& factor) { return static_cast<float>(factor.error); });
    archive.finish();
  });
}

void write_surfaces(const std::filesystem::path& file, const Scene& scene, std::span<const double> areas) {
  fmt::memory_buffer text;
  const fmt::appender end(text);
  fmt::format_to(end, "row,group,side,area_m2\n");
  std::size_t row = 0;
  for (std::size_t surface = 0; surface < areas.size(); ++surface)
    if (areas[surface] > 0)
      fmt::format_to(end, "{},{},{},{:.12g}\n", row++, csv_field(scene.groups[surface / 2]),
                     surface % 2 == 0 ? "front" : "back", areas[surface]);
  write_bytes_atomically(file, {text.data(), text.size()});
}

}  // namespace fluxel
