#include "output/face_factor_files.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <system_error>

#include "core/file.hpp"
#include "core/version.hpp"
#include "output/csv.hpp"
#include "output/numpy_file.hpp"

namespace fluxel {

namespace {

/// Numbers from 1 of the surfaces that have an area.
class FaceNumbers {
 public:
  explicit FaceNumbers(std::span<const double> areas) : numbers_(areas.size(), 0) {
    for (std::size_t surface = 0; surface < areas.size(); ++surface)
      if (areas[surface] > 0) numbers_[surface] = ++count_;
  }

  [[nodiscard]] std::uint32_t of(std::size_t surface) const { return numbers_[surface]; }
  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  std::vector<std::uint32_t> numbers_;
  std::uint32_t count_ = 0;
};

void write_faces(const std::filesystem::path& file, const Scene& scene, std::span<const double> areas,
                 const FaceNumbers& numbers) {
  fmt::memory_buffer text;
  const fmt::appender end(text);
  fmt::format_to(end, "face,patch,side,group,area_m2\n");
  for (std::size_t surface = 0; surface < areas.size(); ++surface)
    if (areas[surface] > 0)
      fmt::format_to(end, "{},{},{},{},{:.12g}\n", numbers.of(surface), surface / 2,
                     surface % 2 == 0 ? "front" : "back",
                     csv_field(scene.groups[index(scene.patches[surface / 2].group)]), areas[surface]);
  write_bytes_atomically(file, {text.data(), text.size()});
}

/// A header, then what `add` makes of each factor, a row of the matrix at a time.
template <class Add>
void write_rows(const std::filesystem::path& file, std::string_view header, const ExchangeTable& faces,
                const Add& add) {
  write_parts_atomically(file, [&](const auto& append) {
    append(header);
    fmt::memory_buffer bytes;
    visit_rows(faces, [&](std::span<const SurfaceViewFactor> row) {
      bytes.clear();
      for (const SurfaceViewFactor& factor : row) add(factor, bytes);
      append({bytes.data(), bytes.size()});
    });
  });
}

/// Coordinate format of real numbers: R. F. Boisvert, R. Pozo and K. A. Remington, The Matrix Market Exchange
/// Formats, NISTIR 5935 (1996).
void write_matrix_market(const std::filesystem::path& file, const Scene& scene, const ExchangeTable& faces,
                         const FaceNumbers& numbers) {
  const std::string header = fmt::format(
      "%%MatrixMarket matrix coordinate real general\n"
      "% fluxel {}\n"
      "% Entry (i, j) is the view factor from face i to face j, the part of what leaves i that "
      "reaches j.\n"
      "% Faces are the sides of the {} patches, numbered from 1 by patch, fronts first.\n"
      "% The rows of {} are these faces in this order, with their areas in m2.\n"
      "{} {} {}\n",
      version(), scene.patches.size(), kFaceFile, numbers.count(), numbers.count(),
      count_view_factors(faces.exchanges));
  write_rows(file, header, faces, [&](const SurfaceViewFactor& f, fmt::memory_buffer& text) {
    fmt::format_to(fmt::appender(text), FMT_COMPILE("{} {} {:.10g}\n"), numbers.of(f.from), numbers.of(f.to),
                   f.value);
  });
}

template <class Number>
void append_number(fmt::memory_buffer& bytes, const Number& number) {
  const char* const first = reinterpret_cast<const char*>(&number);
  bytes.append(first, first + sizeof number);
}

/// An array of records.
void write_numpy(const std::filesystem::path& file, const ExchangeTable& faces, const FaceNumbers& numbers) {
  const std::string header =
      numpy_header("[('from', '<u4'), ('to', '<u4'), ('view_factor', '<f8'), ('error_estimate', '<f8')]",
                   {count_view_factors(faces.exchanges)});
  write_rows(file, header, faces, [&](const SurfaceViewFactor& f, fmt::memory_buffer& bytes) {
    append_number(bytes, numbers.of(f.from));
    append_number(bytes, numbers.of(f.to));
    append_number(bytes, f.value);
    append_number(bytes, f.error);
  });
}

void write_table(const std::filesystem::path& file, const ExchangeTable& faces, const FaceNumbers& numbers) {
  write_rows(file, "from,to,view_factor,error_estimate\n", faces,
             [&](const SurfaceViewFactor& f, fmt::memory_buffer& text) {
               fmt::format_to(fmt::appender(text), FMT_COMPILE("{},{},{:.10g},{:.2g}\n"), numbers.of(f.from),
                              numbers.of(f.to), f.value, f.error);
             });
}

void remove_stale(const std::filesystem::path& file) {
  std::error_code ignored;  // what cannot be removed is not in the way
  std::filesystem::remove(file, ignored);
}

}  // namespace

std::vector<std::string> write_face_factors(const std::filesystem::path& folder, const Scene& scene,
                                            const ExchangeTable& faces, std::span<const std::string> asked) {
  const FaceNumbers numbers(faces.areas);
  std::vector<std::string> written;
  for (const FaceFactorFile& file : kFaceFactorFiles) {
    if (std::ranges::find(asked, file.asked) == asked.end()) {
      remove_stale(folder / file.name);
      continue;
    }
    if (file.asked == "mtx")
      write_matrix_market(folder / file.name, scene, faces, numbers);
    else if (file.asked == "npy")
      write_numpy(folder / file.name, faces, numbers);
    else
      write_table(folder / file.name, faces, numbers);
    written.emplace_back(file.name);
  }
  if (written.empty()) {
    remove_stale(folder / kFaceFile);
    return written;
  }
  write_faces(folder / kFaceFile, scene, faces.areas, numbers);
  written.emplace_back(kFaceFile);
  return written;
}

}  // namespace fluxel
