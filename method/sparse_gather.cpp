#include "method/sparse_gather.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>

#include "final_gather/irradiance_cache.hpp"
#include "final_gather/record_places.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"

namespace fluxel {

namespace {

/// Of the error that is allowed of the picture, that of interpolation at a pixel: others have less.
constexpr double kInterpolated = 1;

constexpr int kMostPasses = 5;

/// So few of the pixels that still ask are gathered each on its own: another pass would take as long.
constexpr double kSingle = 1e-3;

/// Over what is allowed: what is left of errors is not far above it, and their mean square is below.
constexpr float kTooLarge = 2;

/// Pixels to each side over which the noise of single ones is averaged, and how many of what records tell of
/// noise there it is averaged with: a pixel's own two halves tell little.
constexpr std::size_t kAround = 3;
constexpr double kOfRecords = 2;

/// Over the variance of its own rays, the squared error between records from which a pixel is better singly:
/// noise makes records look further off than they are, and specks are seen.
constexpr double kBetter = 4;

/// What black surfaces have of the reflectance by which errors count.
constexpr double kReflectanceOfBlack = 0.1;

/// Of the rays of the first pass, and from one SparseGoal::seed to the next; other rays have seeds of their
/// own.
constexpr std::uint64_t kRecordSeed = std::uint64_t{1} << 36, kSeeds = 64;

/// What records say of a pixel.
struct PixelLight {
  Rgb irradiance{0};   // [W/m2]
  float over = 0;      // error over what is allowed; infinity where no record reaches
  float reach = 0;     // of records [m]
  double squared = 0;  // expected error of the radiosity, with noise [W2/m4], of the mean of the colours
  double noise = 0;    // variance of a record around, likewise
};

/// Of the mean of two halves, of the mean of the colours.
double variance_of(const Rgb& a, const Rgb& b) {
  const double half = 0.5 * mean_of_colours(a - b);
  return half * half;
}

class SparseGather {
 public:
  SparseGather(const Problem& problem, IrradianceSource& source, int width,
               std::span<const GatherPoint> points, const SparseGoal& goal)
      : problem_(problem),
        source_(source),
        width_(static_cast<std::size_t>(width)),
        points_(points),
        goal_(goal),
        seen_(side_points()),
        places_(width, seen_),
        pixels_(points.size()) {}

  SparseLight run() && {
    std::vector<std::uint32_t> all(points_.size());
    std::iota(all.begin(), all.end(), 0U);
    std::erase_if(all, [this](std::uint32_t pixel) { return points_[pixel].face == kNoNode; });
    for (const std::uint32_t pixel : all)
      mean_reflectance_ += reflectance(pixel) / static_cast<double>(all.size());
    std::vector<std::uint32_t> asking = all;
    std::vector<std::uint32_t> chosen = places_.first();
    for (int pass = 0; pass < kMostPasses && !chosen.empty(); ++pass) {
      add_records(chosen);
      problem_.progress.update(pass + 1, kMostPasses);
      look(asking);
      std::erase_if(asking, [this](std::uint32_t pixel) { return !(pixels_[pixel].over > 1); });
      if (static_cast<double>(asking.size()) <= kSingle * static_cast<double>(all.size())) break;
      chosen = places_.more(errors_of(asking));
    }
    // With all records: between pixels that have been looked at in different passes there would be steps.
    look(all);
    std::vector<std::uint32_t> single = std::move(all);
    std::erase_if(single, [this](std::uint32_t pixel) { return !may_be_better_singly(pixel); });
    return result(gather_singly(single));
  }

 private:
  [[nodiscard]] std::vector<SidePoint> side_points() const {
    std::vector<SidePoint> seen(points_.size());
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if (points_[k].face == kNoNode) continue;
      const Node& face = source_.tree()[points_[k].face];
      seen[k] = {points_[k].position, face.shape.normal, face.piece};
    }
    return seen;
  }

  [[nodiscard]] std::vector<GatherPoint> gather_points(std::span<const std::uint32_t> pixels) const {
    std::vector<GatherPoint> places;
    places.reserve(pixels.size());
    for (const std::uint32_t pixel : pixels) {
      places.push_back(points_[pixel]);
      // By rays, dark surfaces have few of them; their records count for bright ones beside them too.
      if (source_.by_rays())
        places.back().weight =
            std::sqrt(mean_reflectance_ / std::max(reflectance(pixel), kReflectanceOfBlack));
    }
    return places;
  }

  /// With rays of its own.
  [[nodiscard]] GatherGoal next_goal() {
    return {goal_.ray_error, source_.mean_radiosity(), kRecordSeed + kSeeds * goal_.seed + gathered_++,
            LightFrom::reflection};
  }

  [[nodiscard]] std::array<std::vector<Rgb>, 2> gather(std::span<const std::uint32_t> pixels) {
    SilentProgress silent;
    return source_.gather_halves(gather_points(pixels), next_goal(), silent);
  }

  void add_records(std::span<const std::uint32_t> chosen) {
    const auto [a, b] = gather(chosen);
    for (std::size_t k = 0; k < chosen.size(); ++k)
      records_.push_back({seen_[chosen[k]], 0.5 * (a[k] + b[k]), variance_of(a[k], b[k])});
    cache_.emplace(problem_.ray_scene, records_, problem_.threads);
  }

  [[nodiscard]] double reflectance(std::uint32_t pixel) const {
    return mean_of_colours(source_.tree().material(points_[pixel].face).rho);
  }

  [[nodiscard]] PixelLight light_of(std::uint32_t pixel) const {
    const Interpolated found = cache_->at(seen_[pixel]);
    PixelLight light;
    if (found.records == 0) {
      light.over = std::numeric_limits<float>::infinity();
      return light;
    }
    const double rho = reflectance(pixel), mean = mean_of_colours(goal_.mean);
    const double counts = std::max(rho, kReflectanceOfBlack) * found.bias();
    light.irradiance = found.irradiance;
    light.reach = static_cast<float>(found.reach);
    // Where all is dark there is nothing to be off by.
    if (counts > 0) light.over = static_cast<float>(counts / (kInterpolated * goal_.allowed * mean));
    light.squared = rho * rho * (found.bias() * found.bias() + found.noise);
    light.noise = found.record_noise;
    return light;
  }

  /// Collective: each rank a part of the pixels.
  void look(std::span<const std::uint32_t> pixels) {
    const Ranks ranks = ranks_of(problem_.world);
    const std::size_t from = pixels.size() * ranks.rank / ranks.size;
    std::vector<PixelLight> own(pixels.size() * (ranks.rank + 1) / ranks.size - from);
    tbb::task_arena(problem_.threads).execute([&] {
      constexpr std::size_t kGrain = 256;
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, own.size(), kGrain), [&](const auto& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) own[k] = light_of(pixels[from + k]);
      });
    });
    const std::vector<PixelLight> found = ranks.gather(std::span<const PixelLight>(own));
    for (std::size_t k = 0; k < pixels.size(); ++k) pixels_[pixels[k]] = found[k];
  }

  [[nodiscard]] std::vector<PixelError> errors_of(std::span<const std::uint32_t> pixels) const {
    std::vector<PixelError> errors;
    errors.reserve(pixels.size());
    for (const std::uint32_t pixel : pixels)
      errors.push_back({pixel, pixels_[pixel].over, pixels_[pixel].reach});
    return errors;
  }

  /// Unless its own rays should be too noisy.
  [[nodiscard]] bool may_be_better_singly(std::uint32_t pixel) const {
    const double rho = reflectance(pixel);
    const PixelLight& light = pixels_[pixel];
    if (light.reach == 0) return light.over > 0;
    return light.over > kTooLarge && light.squared > rho * rho * light.noise;
  }

  /// Where rays of its own are noisier a pixel is left between its records. Returns how many are not.
  std::size_t gather_singly(std::span<const std::uint32_t> pixels) {
    const auto [a, b] = gather(pixels);
    std::vector<double> noise(pixels_.size(), -1);
    for (std::size_t k = 0; k < pixels.size(); ++k) noise[pixels[k]] = variance_of(a[k], b[k]);
    std::size_t single = 0;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      PixelLight& light = pixels_[pixels[k]];
      const double rho = reflectance(pixels[k]);
      const double squared = rho * rho * noise_around(pixels[k], noise);
      if (light.reach > 0 && light.squared <= kBetter * squared) continue;
      light = {0.5 * (a[k] + b[k]), 0, 0, squared, light.noise};
      ++single;
    }
    return single;
  }

  /// Variance of a single pixel, as it and those around it tell; `noise`: below 0 of others.
  [[nodiscard]] double noise_around(std::uint32_t pixel, std::span<const double> noise) const {
    const std::size_t column = pixel % width_, row = pixel / width_, rows = noise.size() / width_;
    double count = pixels_[pixel].reach > 0 ? kOfRecords : 0, sum = count * pixels_[pixel].noise;
    for (std::size_t y = row - std::min(row, kAround); y < std::min(row + kAround + 1, rows); ++y)
      for (std::size_t x = column - std::min(column, kAround); x < std::min(column + kAround + 1, width_);
           ++x) {
        const std::size_t other = y * width_ + x;
        if (noise[other] < 0 || seen_[other].piece != seen_[pixel].piece) continue;
        sum += noise[other];
        ++count;
      }
    return sum / count;
  }

  [[nodiscard]] SparseLight result(std::size_t single) const {
    SparseLight light;
    light.records = records_.size();
    light.single = single;
    light.irradiance.reserve(pixels_.size());
    double squares = 0;
    std::size_t seen = 0;
    for (std::size_t k = 0; k < pixels_.size(); ++k) {
      light.irradiance.push_back(pixels_[k].irradiance);
      // Over the mean of what reflects and does not emit.
      const NodeId face = points_[k].face;
      if (face == kNoNode || reflectance(static_cast<std::uint32_t>(k)) == 0 ||
          source_.tree().emission(face) != Rgb(0))
        continue;
      squares += pixels_[k].squared;
      ++seen;
    }
    if (const double mean = mean_of_colours(goal_.mean); mean > 0 && seen > 0)
      light.error = std::sqrt(squares / static_cast<double>(seen)) / mean;
    return light;
  }

  const Problem& problem_;
  IrradianceSource& source_;
  std::size_t width_;  // of the picture
  std::span<const GatherPoint> points_;
  const SparseGoal& goal_;
  std::vector<SidePoint> seen_;  // of the pixels
  RecordPlaces places_;
  std::vector<IrradianceRecord> records_;
  double mean_reflectance_ = 0;  // of what is seen
  std::uint64_t gathered_ = 0;   // times
  std::optional<IrradianceCache> cache_;
  std::vector<PixelLight> pixels_;
};

}  // namespace

SparseLight gather_sparsely(const Problem& problem, IrradianceSource& source, int width,
                            std::span<const GatherPoint> points, const SparseGoal& goal) {
  return SparseGather(problem, source, width, points, goal).run();
}

}  // namespace fluxel
