#pragma once

#include <algorithm>
#include <barrier>
#include <cstddef>
#include <functional>
#include <span>
#include <thread>
#include <vector>

#include "core/ranks.hpp"

namespace fluxel::test_scenes {

/// Threads that work together as the ranks of a host do, each with memory of its own.
class VirtualRanks {
 public:
  /// Runs `work` once a rank, all at the same time.
  static void run(std::size_t count, const std::function<void(const Ranks&)>& work) {
    VirtualRanks shared(count);
    std::vector<std::thread> threads;
    for (std::size_t rank = 0; rank < count; ++rank)
      threads.emplace_back([&, rank] { work(shared.ranks(rank)); });
    for (std::thread& thread : threads) thread.join();
  }

 private:
  explicit VirtualRanks(std::size_t count)
      : all_here_(static_cast<std::ptrdiff_t>(count)), numbers_(count), values_(count), bytes_(count) {}

  Ranks ranks(std::size_t rank) {
    return {rank,
            numbers_.size(),
            [this, rank](std::span<std::uint64_t> mine) {
              reduce(rank, mine, numbers_, [](std::uint64_t a, std::uint64_t b) { return a + b; });
            },
            [this, rank](std::span<double> mine) {
              reduce(rank, mine, values_, [](double a, double b) { return std::max(a, b); });
            },
            [this, rank](std::span<const std::byte> mine) {
              bytes_[rank] = mine;
              all_here_.arrive_and_wait();
              std::vector<std::byte> all;
              for (const std::span<const std::byte> part : bytes_)
                all.insert(all.end(), part.begin(), part.end());
              all_here_.arrive_and_wait();
              return all;
            },
            rank == 0,
            [this, rank](std::span<std::byte> mine) {
              bytes_[rank] = mine;
              all_here_.arrive_and_wait();
              std::ranges::copy(bytes_[0], mine.begin());
              all_here_.arrive_and_wait();
            }};
  }

  template <class T, class Operation>
  void reduce(std::size_t rank, std::span<T> mine, std::vector<std::span<T>>& of_ranks,
              const Operation& operation) {
    of_ranks[rank] = mine;
    all_here_.arrive_and_wait();
    std::vector<T> result(of_ranks[0].begin(), of_ranks[0].end());
    for (std::size_t other = 1; other < of_ranks.size(); ++other)
      for (std::size_t k = 0; k < result.size(); ++k) result[k] = operation(result[k], of_ranks[other][k]);
    all_here_.arrive_and_wait();
    std::ranges::copy(result, mine.begin());
  }

  std::barrier<> all_here_;
  std::vector<std::span<std::uint64_t>> numbers_;
  std::vector<std::span<double>> values_;
  std::vector<std::span<const std::byte>> bytes_;
};

}  // namespace fluxel::test_scenes
