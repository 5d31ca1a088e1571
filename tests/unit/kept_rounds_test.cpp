#include "hierarchy/kept_rounds.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "hierarchy/link_file.hpp"

namespace fluxel {
namespace {

constexpr std::uint64_t kIdentity = 0x1234;

KeptRounds example() {
  KeptRounds kept;
  kept.ranks = 3;
  kept.rounds = {{1e-3, 10, 0, 20, 15, 4, std::nullopt, std::nullopt, 0.5, 0.25},
                 {1e-4, std::uint64_t{1} << 40, 17, 200, 150, 5, 0.1, 0.2, 1.5, 2.25}};
  kept.halvings = {{7, 1}, {9, 0}, {8, 2}};
  kept.cut = {1, 4, 5};
  Radiosity& radiosity = kept.radiosity;
  radiosity.B = {Rgb(1, 2, 3), Rgb(4, 5, 6)};
  radiosity.H = {Rgb(7, 8, 9), Rgb(1, 0, 1)};
  radiosity.solver = Solver::conjugate_gradients;
  radiosity.channels = 1;
  radiosity.iterations = 5;
  radiosity.residual = 1e-5;
  radiosity.error_bound = std::numeric_limits<double>::infinity();
  radiosity.largest_bound = Rgb(1, 2, 3);
  radiosity.mean_square_bound = Rgb(3, 2, 1);
  radiosity.cause = "too few iterations";
  kept.paths = {{Rgb(1, 2, 3), Rgb(0, 0, 1)}, 8, 17, std::uint64_t{1} << 33, 1.5};
  return kept;
}

RoundsFileResult read(const std::string& bytes) {
  return read_rounds_file(std::as_bytes(std::span(bytes)), kIdentity);
}

TEST(KeptRounds, ComeBack) {
  const std::string bytes = rounds_file(example(), kIdentity);
  const RoundsFileResult result = read(bytes);
  ASSERT_TRUE(result.kept) << result.defect;
  EXPECT_EQ(rounds_file(*result.kept, kIdentity), bytes) << "something is lost";
  const HierarchyRound& last = result.kept->rounds[1];
  EXPECT_EQ(last.links, std::uint64_t{1} << 40);
  EXPECT_EQ(last.rows, 17u);
  EXPECT_EQ(last.nodes, 200u);
  EXPECT_EQ(result.kept->cut, example().cut);
  EXPECT_EQ(last.discretisation, 0.2);
  EXPECT_FALSE(result.kept->rounds[0].change);
  EXPECT_EQ(result.kept->halvings, example().halvings);
  EXPECT_EQ(result.kept->radiosity.H, example().radiosity.H);
  EXPECT_EQ(result.kept->radiosity.solver, Solver::conjugate_gradients);
  EXPECT_FALSE(result.kept->radiosity.converged);
  EXPECT_EQ(result.kept->radiosity.cause, "too few iterations");
  EXPECT_EQ(result.kept->paths.sums, example().paths.sums);
  EXPECT_EQ(result.kept->paths.of_each, 8u);
  EXPECT_EQ(result.kept->paths.seed, 17u);
  EXPECT_EQ(result.kept->paths.rays, std::uint64_t{1} << 33);
  EXPECT_EQ(result.kept->paths.seconds, 1.5);
}

TEST(KeptRounds, EveryDamagedByteIsFound) {
  const std::string bytes = rounds_file(example(), kIdentity);
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    std::string damaged = bytes;
    damaged[k] = static_cast<char>(damaged[k] ^ 1);
    EXPECT_FALSE(read(damaged).kept) << k;
    EXPECT_FALSE(read(bytes.substr(0, k)).kept) << "cut to " << k;
  }
  EXPECT_FALSE(read(bytes + "x").kept);
}

TEST(KeptRounds, OfAnotherIdentityAreForeign) {
  EXPECT_EQ(read(rounds_file(example(), kIdentity + 1)).defect, "is of another scene or other options");
}

// The check sums are right, and the numbers still cannot be.
TEST(KeptRounds, NumbersThatCannotBeAreRefused) {
  KeptRounds kept = example();
  kept.rounds.clear();
  EXPECT_FALSE(read(rounds_file(kept, kIdentity)).kept) << "no round";
  kept = example();
  kept.ranks = 0;
  EXPECT_FALSE(read(rounds_file(kept, kIdentity)).kept) << "no ranks";
  kept = example();
  kept.radiosity.solver = Solver::gauss_seidel;
  EXPECT_FALSE(read(rounds_file(kept, kIdentity)).kept) << "a solver that links do not have";
  kept = example();
  kept.radiosity.H.pop_back();
  EXPECT_FALSE(read(rounds_file(kept, kIdentity)).kept) << "fewer H than B";
  kept = example();
  kept.paths.sums[1].g = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(read(rounds_file(kept, kIdentity)).kept) << "paths that have found no number";
  kept = example();
  kept.paths.of_each = 0;
  EXPECT_FALSE(read(rounds_file(kept, kIdentity)).kept) << "sums of no paths";
}

// 70,000 links are three segments.
std::vector<Link> many_links() {
  std::vector<Link> links(70000);
  for (std::uint32_t k = 0; k < links.size(); ++k)
    links[k] = {k % 1000, k % 777, static_cast<float>(k), 0.5f, {1, -2}, {-127, 127}, k % 2 == 0};
  return links;
}

constexpr LinkFileKey kKey{kIdentity, 4};

std::string file_of(std::span<const Link> links) {
  std::ostringstream stream(std::ios::binary);
  write_link_file(stream, kKey, links, {1, 2, 3, 4});
  return stream.str();
}

LinkFileResult read_links(const std::string& bytes, std::size_t nodes = 1000, std::uint64_t part = 0,
                          std::uint64_t parts = 1) {
  std::istringstream stream(bytes, std::ios::binary);
  return read_link_file(stream, kKey, nodes, [&](std::uint64_t segment) { return segment % parts == part; });
}

void expect_equal(std::span<const Link> found, std::span<const Link> expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Link &a = found[k], &b = expected[k];
    ASSERT_TRUE(a.p == b.p && a.q == b.q && a.G == b.G && a.G_error == b.G_error && a.partial == b.partial)
        << k;
    ASSERT_TRUE(a.over_p.u == b.over_p.u && a.over_p.v == b.over_p.v && a.over_q.u == b.over_q.u &&
                a.over_q.v == b.over_q.v)
        << k;
  }
}

TEST(LinkFile, ComesBackWholeAndInParts) {
  const std::vector<Link> links = many_links();
  const std::string bytes = file_of(links);
  const LinkFileResult whole = read_links(bytes);
  EXPECT_EQ(whole.defect, "");
  expect_equal(whole.links, links);
  EXPECT_EQ(whole.counts.rays, 4u);
  const std::vector<Link> even = read_links(bytes, 1000, 0, 2).links,
                          odd = read_links(bytes, 1000, 1, 2).links;
  expect_equal(odd, std::span(links).subspan(32768, 32768));
  EXPECT_EQ(even.size() + odd.size(), links.size());
}

TEST(LinkFile, NoLinksAreAFileToo) {
  const LinkFileResult result = read_links(file_of({}));
  EXPECT_EQ(result.defect, "");
  EXPECT_TRUE(result.links.empty());
}

TEST(LinkFile, DamageIsFound) {
  const std::vector<Link> links = many_links();
  const std::string bytes = file_of(std::span(links).first(5));
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    std::string damaged = bytes;
    damaged[k] = static_cast<char>(damaged[k] ^ 1);
    EXPECT_NE(read_links(damaged).defect, "") << k;
    EXPECT_NE(read_links(bytes.substr(0, k)).defect, "") << "cut to " << k;
  }
  EXPECT_NE(read_links(bytes + "x").defect, "");
}

TEST(LinkFile, LinksOfNodesThatAreNotThereAreRefused) {
  EXPECT_NE(read_links(file_of(many_links()), 999).defect, "");
}

TEST(LinkFile, OfAnotherRoundIsForeign) {
  std::istringstream stream(file_of(many_links()), std::ios::binary);
  const auto all = [](std::uint64_t) { return true; };
  EXPECT_EQ(read_link_file(stream, {kIdentity, 5}, 1000, all).defect, "is of another round or other options");
}

}  // namespace
}  // namespace fluxel
