#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "optics/luminaire_emission.hpp"
#include "photons/photon_numbers.hpp"
#include "photons/photon_scene.hpp"
#include "sampling/cuda/chosen_part.hpp"
#include "scene/scene.hpp"

namespace fluxel::bench {

// Ways for photons to go that the program does not have, to compare with.

/// Halves by even and odd indices, which are right for numbers that look random alone.
template <class Sequence>
class EvenAndOdd {
 public:
  static constexpr std::size_t kParts = 2;
  static constexpr std::size_t kDimensions = Sequence::kDimensions;

  explicit EvenAndOdd(std::uint64_t /*seed*/) {}

  std::size_t start(std::uint64_t index) {
    sequence_.start(index);
    return index % kParts;
  }
  double next() { return sequence_.next(); }

 private:
  Sequence sequence_;
};

/// A coordinate for each choice: nothing that a choice leaves is used again (equation 11).
template <class Points>
class NoReuse : public PhotonNumbers<Points> {
 public:
  using PhotonNumbers<Points>::PhotonNumbers;
  double next_of_choice() { return this->next(); }
  void keep(double /*rest*/) {}
};

/// Emission of a point luminaire by rejection: a cell by its flux, then angles, even in it, until one is
/// taken.
class RejectedEmission {
 public:
  explicit RejectedEmission(const Scene& scene, double lift)
      : luminaire_(scene.luminaires.front()), table_(scene.intensity(luminaire_)), lift_(lift) {
    const std::size_t planes = std::max<std::size_t>(1, table_.C.size() - 1);
    double sum = 0;
    for (std::size_t c = 0; c < planes; ++c)
      for (std::size_t g = 0; g + 1 < table_.gamma.size(); ++g) {
        const IntensityCell of(table_, c, g);
        if (!(of.flux() > 0)) continue;
        const bool is_turned = table_.C.size() > 1;
        Cell cell{is_turned ? table_.C[c] : 0, is_turned ? table_.C[c + 1] : 2 * 3.14159265358979323846,
                  table_.gamma[g], table_.gamma[g + 1], 0};
        const std::size_t other = is_turned ? c + 1 : c;
        const double most_sine = cell.gamma_from <= 1.5707963267948966 && cell.gamma_to >= 1.5707963267948966
                                     ? 1
                                     : std::max(std::sin(cell.gamma_from), std::sin(cell.gamma_to));
        cell.most = most_sine * std::max({table_.at(c, g), table_.at(other, g), table_.at(c, g + 1),
                                          table_.at(other, g + 1)});
        cells_.push_back(cell);
        ends_.push_back(sum += of.flux());
      }
  }

  template <class Numbers>
  EmittedPhoton operator()(Numbers& numbers) const {
    const Cell& cell = cells_[cuda::chosen_part(ends_.data(), ends_.size(), numbers.next()).number];
    for (;;) {
      const double C = std::lerp(cell.C_from, cell.C_to, numbers.next());
      const double gamma = std::lerp(cell.gamma_from, cell.gamma_to, numbers.next());
      if (numbers.next() * cell.most > intensity(table_, C, gamma) * std::sin(gamma)) continue;
      const double sine = std::sin(gamma), cosine = std::cos(gamma);
      const glm::dvec3 across = glm::cross(luminaire_.ahead, luminaire_.aim);
      return {{luminaire_.position + (cosine > 0 ? lift_ : -lift_) * luminaire_.aim,
               sine * std::cos(C) * luminaire_.ahead + sine * std::sin(C) * across + cosine * luminaire_.aim},
              Rgb(1)};
    }
  }

 private:
  struct Cell {
    double C_from, C_to, gamma_from, gamma_to, most;
  };

  const Luminaire& luminaire_;
  const IntensityTable& table_;
  double lift_;
  std::vector<Cell> cells_;
  std::vector<double> ends_;
};

}  // namespace fluxel::bench
