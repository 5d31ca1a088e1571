#include "mpi_master/communication/communicator.hpp"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <climits>
#include <cstdlib>
#include <list>
#include <stdexcept>
#include <thread>

#include "mpi_master/communication/launcher.hpp"
#include "mpi_master/scheduling/back_off.hpp"

namespace fluxel {

namespace {

void check(int code, const char* call) {
  if (code == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(code, text.data(), &length);
  throw std::runtime_error(fmt::format("{} failed: {}", call, text.data()));
}

/// A collective call goes on only where it is looked at, and each of its steps waits for the rank that it
/// leads to: as long as it takes where all have come, nobody sleeps, and afterwards not for long.
constexpr std::chrono::microseconds kAwake{200}, kShortSleep{50};

/// What MPI's own waits do, but asleep after a while: theirs take a whole processor.
void wait(MPI_Request& request) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point sleepy = Clock::now() + kAwake;
  BackOff pause(kShortSleep);
  for (int done = 0;;) {
    check(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
    if (done != 0) return;
    if (Clock::now() < sleepy)
      std::this_thread::yield();
    else
      pause.wait();
  }
}

constexpr std::size_t kLargestCall = std::size_t{1} << 30;  // bytes; counts of MPI 3 are int

struct PendingSend {
  Bytes bytes;
  MPI_Request request = MPI_REQUEST_NULL;
};

/// MPI reads counts and places until the end.
struct PendingGather {
  std::vector<int> counts, first;
  MPI_Request request = MPI_REQUEST_NULL;
};

/// An item as one MPI type keeps counts and displacements, which are int, far from their limit.
class ItemType {
 public:
  explicit ItemType(std::size_t bytes) {
    check(MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type_), "MPI_Type_contiguous");
    check(MPI_Type_commit(&type_), "MPI_Type_commit");
  }
  /// MPI keeps it for calls that are under way.
  ~ItemType() { MPI_Type_free(&type_); }
  ItemType(const ItemType&) = delete;
  ItemType& operator=(const ItemType&) = delete;

  [[nodiscard]] MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

void require_int(std::size_t items) {
  if (items > INT_MAX) throw std::length_error("more than 2^31 items in one gathering");
}

template <class T>
void all_reduce(std::span<T> values, MPI_Datatype type, MPI_Op operation, MPI_Comm communicator) {
  constexpr std::size_t kItems = kLargestCall / sizeof(T);
  for (std::size_t first = 0; first < values.size(); first += kItems) {
    const std::size_t count = std::min(kItems, values.size() - first);
    MPI_Request request = MPI_REQUEST_NULL;
    check(MPI_Iallreduce(MPI_IN_PLACE, values.data() + first, static_cast<int>(count), type, operation,
                         communicator, &request),
          "MPI_Iallreduce");
    wait(request);
  }
}

}  // namespace

struct Communicator::State {
  MPI_Comm communicator = MPI_COMM_NULL;
  int rank = 0;
  int size = 1;
  std::list<PendingSend> sends;
  SentCounts sent;
  std::vector<std::uint64_t> messages_to;  // each rank, so far
  std::uint64_t messages_received = 0;
  std::list<PendingGather> gathers;
  std::vector<ItemRange> hosts;
  std::optional<Communicator> host, leaders;

  /// Takes over `own`.
  explicit State(MPI_Comm own) : communicator(own) {
    check(MPI_Comm_set_errhandler(communicator, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
    check(MPI_Comm_rank(communicator, &rank), "MPI_Comm_rank");
    check(MPI_Comm_size(communicator, &size), "MPI_Comm_size");
    messages_to.resize(static_cast<std::size_t>(size));
  }
  ~State() { MPI_Comm_free(&communicator); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

int Communicator::rank() const { return state_->rank; }
int Communicator::size() const { return state_->size; }

void Communicator::barrier() const {
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Ibarrier(state_->communicator, &request), "MPI_Ibarrier");
  wait(request);
}

void Communicator::broadcast(Bytes& bytes, int root) const {
  std::uint64_t size = bytes.size();
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Ibcast(&size, 1, MPI_UINT64_T, root, state_->communicator, &request), "MPI_Ibcast");
  wait(request);
  bytes.resize(size);
  for (std::size_t first = 0; first < size; first += kLargestCall) {
    const std::size_t count = std::min<std::size_t>(kLargestCall, size - first);
    check(MPI_Ibcast(bytes.data() + first, static_cast<int>(count), MPI_BYTE, root, state_->communicator,
                     &request),
          "MPI_Ibcast");
    wait(request);
  }
}

void Communicator::all_min(std::span<double> values) const {
  all_reduce(values, MPI_DOUBLE, MPI_MIN, state_->communicator);
}
void Communicator::all_max(std::span<double> values) const {
  all_reduce(values, MPI_DOUBLE, MPI_MAX, state_->communicator);
}
void Communicator::all_min(std::span<std::uint64_t> values) const {
  all_reduce(values, MPI_UINT64_T, MPI_MIN, state_->communicator);
}
void Communicator::all_min(std::span<std::uint32_t> values) const {
  all_reduce(values, MPI_UINT32_T, MPI_MIN, state_->communicator);
}
void Communicator::all_sum(std::span<std::uint64_t> values) const {
  all_reduce(values, MPI_UINT64_T, MPI_SUM, state_->communicator);
}

Bytes Communicator::all_gather_bytes(std::span<const std::byte> mine, std::size_t item) const {
  std::uint64_t my_items = mine.size() / item;
  std::vector<std::uint64_t> items(static_cast<std::size_t>(state_->size));
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Iallgather(&my_items, 1, MPI_UINT64_T, items.data(), 1, MPI_UINT64_T, state_->communicator,
                       &request),
        "MPI_Iallgather");
  wait(request);
  std::uint64_t total = 0;
  std::vector<int> counts, first;
  for (const std::uint64_t count : items) {
    counts.push_back(static_cast<int>(count));
    first.push_back(static_cast<int>(total));
    total += count;
  }
  require_int(total);
  const ItemType type(item);
  Bytes all(total * item);
  check(MPI_Iallgatherv(mine.data(), static_cast<int>(my_items), type.get(), all.data(), counts.data(),
                        first.data(), type.get(), state_->communicator, &request),
        "MPI_Iallgatherv");
  wait(request);
  return all;
}

void Communicator::start_gather_bytes(std::span<std::byte> all, std::size_t item,
                                      std::span<const ItemRange> of_ranks) const {
  require_int(all.size() / item);
  PendingGather& gather = state_->gathers.emplace_back();
  for (const ItemRange& range : of_ranks) {
    gather.counts.push_back(static_cast<int>(range.count));
    gather.first.push_back(static_cast<int>(range.first));
  }
  const ItemType type(item);
  check(MPI_Iallgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, all.data(), gather.counts.data(),
                        gather.first.data(), type.get(), state_->communicator, &gather.request),
        "MPI_Iallgatherv");
}

void Communicator::advance_gathers() const {
  std::erase_if(state_->gathers, [](PendingGather& gather) {
    int done = 0;
    check(MPI_Test(&gather.request, &done, MPI_STATUS_IGNORE), "MPI_Test");
    return done != 0;
  });
}

void Communicator::finish_gathers() const {
  for (PendingGather& gather : state_->gathers) wait(gather.request);
  state_->gathers.clear();
}

void Communicator::send(int target, int tag, Bytes bytes) const {
  if (bytes.size() > kLargestCall) throw std::length_error("a message of more than 1 GiB");
  ++state_->sent.messages;
  state_->sent.bytes += bytes.size();
  ++state_->messages_to[static_cast<std::size_t>(target)];
  PendingSend& entry = state_->sends.emplace_back();
  entry.bytes = std::move(bytes);
  check(MPI_Isend(entry.bytes.data(), static_cast<int>(entry.bytes.size()), MPI_BYTE, target, tag,
                  state_->communicator, &entry.request),
        "MPI_Isend");
}

const SentCounts& Communicator::sent() const { return state_->sent; }

std::size_t Communicator::pending_sends() const {
  std::erase_if(state_->sends, [](PendingSend& entry) {
    int gone = 0;
    check(MPI_Test(&entry.request, &gone, MPI_STATUS_IGNORE), "MPI_Test");
    return gone != 0;
  });
  return state_->sends.size();
}

std::optional<Message> Communicator::receive() const {
  int arrived = 0;
  MPI_Status status;
  check(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, state_->communicator, &arrived, &status), "MPI_Iprobe");
  if (arrived == 0) return std::nullopt;
  int count = 0;
  check(MPI_Get_count(&status, MPI_BYTE, &count), "MPI_Get_count");
  Message message{status.MPI_SOURCE, status.MPI_TAG, Bytes(static_cast<std::size_t>(count))};
  check(MPI_Recv(message.data.data(), count, MPI_BYTE, message.source, message.tag, state_->communicator,
                 MPI_STATUS_IGNORE),
        "MPI_Recv");
  ++state_->messages_received;
  return message;
}

void Communicator::receive_all(const std::function<void(const Message&)>& take) const {
  // Who has been sent how much, from all ranks; others may still wait for what they send to be received.
  std::uint64_t sent_here = 0;
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Ireduce_scatter_block(state_->messages_to.data(), &sent_here, 1, MPI_UINT64_T, MPI_SUM,
                                  state_->communicator, &request),
        "MPI_Ireduce_scatter_block");
  BackOff pause;
  for (int known = 0; known == 0 || state_->messages_received < sent_here || pending_sends() > 0;) {
    if (known == 0) check(MPI_Test(&request, &known, MPI_STATUS_IGNORE), "MPI_Test");
    if (const auto message = receive()) {
      take(*message);
      pause.reset();
    } else {
      pause.wait();
    }
  }
  barrier();
}

void Communicator::abort(int code) const {
  MPI_Abort(state_->communicator, code);
  std::abort();
}

Communicator Communicator::split(int group) const {
  MPI_Comm own = MPI_COMM_NULL;
  check(MPI_Comm_split(state_->communicator, group, state_->rank, &own), "MPI_Comm_split");
  return Communicator(std::make_shared<State>(own));
}

Communicator Communicator::ordered_by_hosts(int host) const {
  const std::vector<int> of_ranks = all_gather(std::span<const int>(&host, 1));
  const auto first_of = [&](int number) {
    return static_cast<int>(std::ranges::find(of_ranks, number) - of_ranks.begin());
  };
  // Equal keys keep their order.
  MPI_Comm same = MPI_COMM_NULL;
  check(MPI_Comm_split(state_->communicator, 0, first_of(host), &same), "MPI_Comm_split");
  Communicator ordered(std::make_shared<State>(same));
  State& state = *ordered.state_;
  std::size_t before = 0;
  for (std::size_t rank = 0; rank < of_ranks.size(); ++rank) {
    if (first_of(of_ranks[rank]) != static_cast<int>(rank)) continue;
    const auto count = static_cast<std::size_t>(std::ranges::count(of_ranks, of_ranks[rank]));
    state.hosts.push_back({before, count});
    before += count;
  }
  state.host = ordered.split(first_of(host));
  state.leaders = ordered.split(state.host->is_root() ? 0 : 1);
  return ordered;
}

std::span<const ItemRange> Communicator::hosts() const { return state_->hosts; }
const Communicator& Communicator::host() const { return state_->host.value(); }
const Communicator& Communicator::leaders() const { return state_->leaders.value(); }

int Communicator::handle() const { return MPI_Comm_c2f(state_->communicator); }

MpiSession::MpiSession(int* argc, char*** argv) : world_(nullptr) {
  start_alone();
  int given = MPI_THREAD_SINGLE;
  check(MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &given), "MPI_Init_thread");
  if (given < MPI_THREAD_FUNNELED)
    throw std::runtime_error(
        "this MPI library gives no funnelled threads; use one built with thread support");
  MPI_Comm all = MPI_COMM_NULL, sharing = MPI_COMM_NULL;
  check(MPI_Comm_dup(MPI_COMM_WORLD, &all), "MPI_Comm_dup");
  const Communicator as_launched(std::make_shared<Communicator::State>(all));
  check(MPI_Comm_split_type(all, MPI_COMM_TYPE_SHARED, as_launched.rank(), MPI_INFO_NULL, &sharing),
        "MPI_Comm_split_type");
  int host = as_launched.rank();  // by its lowest rank
  check(MPI_Bcast(&host, 1, MPI_INT, 0, sharing), "MPI_Bcast");
  MPI_Comm_free(&sharing);
  world_ = as_launched.ordered_by_hosts(host);
}

MpiSession::~MpiSession() {
  world_.state_.reset();
  MPI_Finalize();
}

std::string mpi_version() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int length = 0;
  MPI_Get_library_version(text.data(), &length);
  const std::string whole(text.data(), static_cast<std::size_t>(length));
  return whole.substr(0, whole.find(','));
}

}  // namespace fluxel
