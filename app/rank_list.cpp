#include "app/rank_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace fluxel {

namespace {

/// A name's part before the digits at its end, and these digits.
struct NumberedName {
  std::string stem, digits;
};

NumberedName split_number(const std::string& name) {
  const std::size_t last = name.find_last_not_of("0123456789");
  const std::size_t digits = last == std::string::npos ? 0 : last + 1;
  // A number of more digits is none to count with.
  if (name.size() - digits > 9) return {name, ""};
  return {name.substr(0, digits), name.substr(digits)};
}

bool follows(const std::string& name, const std::string& before) {
  const NumberedName a = split_number(before), b = split_number(name);
  return a.stem == b.stem && a.digits.size() == b.digits.size() && !a.digits.empty() &&
         std::stol(b.digits) == std::stol(a.digits) + 1;
}

std::string fold_numbers(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t first = 0; first < numbers.size();) {
    std::size_t last = first;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    if (!text.empty()) text += ',';
    text += last > first ? fmt::format("{}-{}", numbers[first], numbers[last])
                         : fmt::format("{}", numbers[first]);
    first = last + 1;
  }
  return text;
}

/// Ranks of a host with the same CPU set.
struct Share {
  std::string cpus;
  int threads = 1, ranks = 1;
  bool operator==(const Share&) const = default;
};

/// Hosts whose ranks are placed alike.
struct HostGroup {
  std::vector<std::string> names;
  std::vector<Share> shares;
  std::vector<std::size_t> ranks;
};

void count_rank(const RankPlace& place, std::vector<Share>& shares) {
  const auto share = std::ranges::find_if(
      shares, [&](const Share& other) { return other.cpus == place.cpus && other.threads == place.threads; });
  if (share == shares.end())
    shares.push_back({place.cpus, place.threads, 1});
  else
    ++share->ranks;
}

/// Each host alone, in the order of their first ranks.
std::vector<HostGroup> hosts_of(const std::vector<RankPlace>& places) {
  std::map<std::string, std::size_t> number_of;
  std::vector<HostGroup> hosts;
  for (std::size_t rank = 0; rank < places.size(); ++rank) {
    const RankPlace& place = places[rank];
    const auto [entry, is_new] = number_of.try_emplace(place.host, hosts.size());
    if (is_new) hosts.push_back({{place.host}, {}, {}});
    HostGroup& host = hosts[entry->second];
    count_rank(place, host.shares);
    host.ranks.push_back(rank);
  }
  return hosts;
}

std::string share_text(const Share& share) {
  const std::string each = share.ranks > 1 ? fmt::format("{} ranks with ", share.ranks) : "";
  return fmt::format("{}CPUs {}, {} thread{}{}", each, share.cpus, share.threads,
                     share.threads == 1 ? "" : "s", share.ranks > 1 ? " each" : "");
}

}  // namespace

std::string fold_names(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t first = 0; first < names.size();) {
    std::size_t last = first;
    while (last + 1 < names.size() && follows(names[last + 1], names[last])) ++last;
    if (!text.empty()) text += ',';
    text += last > first ? fmt::format("{}[{}-{}]", split_number(names[first]).stem,
                                       split_number(names[first]).digits, split_number(names[last]).digits)
                         : names[first];
    first = last + 1;
  }
  return text;
}

std::vector<std::string> rank_list(const std::vector<RankPlace>& places) {
  std::vector<HostGroup> groups;
  for (const HostGroup& host : hosts_of(places)) {
    const auto group = std::ranges::find(groups, host.shares, &HostGroup::shares);
    if (group == groups.end()) {
      groups.push_back(host);
      continue;
    }
    group->names.push_back(host.names.front());
    group->ranks.insert(group->ranks.end(), host.ranks.begin(), host.ranks.end());
  }
  for (HostGroup& group : groups) std::ranges::sort(group.ranks);
  std::vector<std::string> lines;
  for (const HostGroup& group : groups) {
    std::string line =
        fmt::format("rank{} {} on {}: {}", group.ranks.size() > 1 ? "s" : "", fold_numbers(group.ranks),
                    fold_names(group.names), group.names.size() > 1 ? "on each " : "");
    for (std::size_t s = 0; s < group.shares.size(); ++s)
      line += (s == 0 ? "" : "; ") + share_text(group.shares[s]);
    lines.push_back(line);
  }
  return lines;
}

}  // namespace fluxel
