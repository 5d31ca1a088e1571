#include "image/exr_reader.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "core/input_error_at.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

namespace {

constexpr const char* kHint = "give an OpenEXR picture of scan lines with the channels R, G and B";
constexpr const char* kComponents[kChannels] = {"R", "G", "B"};

/// Most values a byte of a file, with room to spare: black pixels take 425 in the densest code but those of
/// DWA, which take 4250 (measured with OpenEXR 3.1). What claims to hold more is not believed.
std::uint64_t densest(const Imf::Header& header) {
  const Imf::Compression code = header.compression();
  return code == Imf::DWAA_COMPRESSION || code == Imf::DWAB_COMPRESSION ? 8192 : 1024;
}

/// Rows that OpenEXR makes room for at once, even where the picture has fewer.
std::uint64_t rows_at_once(const Imf::Header& header) {
  switch (header.compression()) {
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      return 1;
  }
}

/// So many values of such rows [64 MB] are no harm, whatever the file's size.
constexpr std::uint64_t kSmallBlock = std::uint64_t{1} << 24;

/// A file in memory, some characters of which read as question marks.
class InputBytes final : public Imf::IStream {
 public:
  InputBytes(const std::string& bytes, const std::vector<std::size_t>& masked)
      : Imf::IStream("memory"), bytes_(bytes), masked_(masked) {}

  bool read(char chars[], int count) override {
    if (count < 0 || static_cast<std::uint64_t>(count) > bytes_.size() - position_)
      throw std::runtime_error("the file ends too early");
    std::memcpy(chars, bytes_.data() + position_, static_cast<std::size_t>(count));
    const std::uint64_t end = position_ + static_cast<std::uint64_t>(count);
    for (auto at = std::ranges::lower_bound(masked_, position_); at != masked_.end() && *at < end; ++at)
      chars[*at - position_] = '?';
    position_ = end;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("the file ends too early");
    position_ = position;
  }

 private:
  const std::string& bytes_;
  const std::vector<std::size_t>& masked_;
  std::uint64_t position_ = 0;
};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw input_error_at(file, 0, what, kHint);
}

/// Refuses what the first eight bytes tell: before OpenEXR makes room for anything.
void require_scan_lines(const std::filesystem::path& file, const std::string& bytes) {
  static_assert(std::endian::native == std::endian::little, "the file is little endian");
  int version = 0;
  if (bytes.size() < 2 * sizeof version || !Imf::isImfMagic(bytes.data())) refuse(file, "is no OpenEXR file");
  std::memcpy(&version, bytes.data() + sizeof version, sizeof version);
  if (Imf::isTiled(version) || Imf::isMultiPart(version) || Imf::isNonImage(version))
    refuse(file, "is an OpenEXR file of tiles, of several parts or of deep pixels, which is not read");
}

/// An attribute that pixels depend on.
struct NeededAttribute {
  std::string_view name, type;
  std::size_t bytes;  ///< 0: as many as it says
};
constexpr std::array kNeeded{
    NeededAttribute{"channels", "chlist", 0},        NeededAttribute{"compression", "compression", 1},
    NeededAttribute{"dataWindow", "box2i", 16},      NeededAttribute{"displayWindow", "box2i", 16},
    NeededAttribute{"lineOrder", "lineOrder", 1},    NeededAttribute{"pixelAspectRatio", "float", 4},
    NeededAttribute{"screenWindowCenter", "v2f", 8}, NeededAttribute{"screenWindowWidth", "float", 4}};

/// Whether a list of channels ends where its attribute does: name, zero, 16 bytes of each, and a zero.
bool is_whole_list(std::string_view list) {
  constexpr std::size_t kOfChannel = 16;
  while (!list.empty() && list.front() != '\0') {
    const std::size_t name = list.find('\0');
    if (name == std::string_view::npos || list.size() - name - 1 < kOfChannel) return false;
    list.remove_prefix(name + 1 + kOfChannel);
  }
  return list.size() == 1;
}

/// Walks over the header's attributes before OpenEXR does, which makes room for as many bytes as one claims,
/// and reads some by their types whatever length they claim. Some types (previews, vectors of strings) have
/// lengths of their own, too: of attributes that no pixel depends on, the places where the types' names begin
/// are given back. With these masked their types are unknown to OpenEXR, and it takes them as mere bytes.
std::vector<std::size_t> places_to_mask(const std::filesystem::path& file, const std::string& bytes) {
  std::size_t at = 8;  // behind the magic number and the version
  const auto take = [&](std::size_t count) {
    if (count > bytes.size() - at) refuse(file, "cannot be read: the file ends too early");
    at += count;
    return bytes.substr(at - count, count);
  };
  const auto take_name = [&] {
    std::string name = take(std::min(bytes.find('\0', at), bytes.size()) + 1 - at);
    name.pop_back();
    return name;
  };
  std::vector<std::size_t> places;
  for (std::string name = take_name(); !name.empty(); name = take_name()) {
    const std::size_t place = at;
    const std::string type = take_name();
    std::int32_t length = 0;
    std::memcpy(&length, take(sizeof length).data(), sizeof length);
    if (length < 0 || static_cast<std::size_t>(length) > bytes.size() - at)
      refuse(file, fmt::format("the attribute '{}' is said to have {} bytes, where the file has {} more",
                               name, length, bytes.size() - at));
    const std::string value = take(static_cast<std::size_t>(length));
    const auto* const needed = std::ranges::find(kNeeded, name, &NeededAttribute::name);
    if (needed == kNeeded.end()) {
      if (!type.empty()) places.push_back(place);
    } else if (type != needed->type ||
               (needed->bytes > 0 ? value.size() != needed->bytes : !is_whole_list(value))) {
      refuse(file, fmt::format("the attribute '{}' is damaged", name));
    }
  }
  return places;
}

Imf::Header read_header(const std::string& bytes, const std::vector<std::size_t>& masked) {
  InputBytes stream(bytes, masked);
  int version = 0;
  stream.seekg(sizeof version);
  stream.read(reinterpret_cast<char*>(&version), sizeof version);
  Imf::Header header;
  header.readFrom(stream, version);
  return header;
}

/// Names of the layers that have R, G or B, each checked to have all three.
std::vector<std::string> layer_names(const std::filesystem::path& file, const Imf::ChannelList& channels) {
  std::vector<std::string> names;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    const std::string name = channel.name();
    const std::size_t dot = name.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : name.substr(0, dot + 1);
    if (std::ranges::find(kComponents, name.substr(layer.size())) == std::end(kComponents)) continue;
    if (channel.channel().type == Imf::UINT || channel.channel().xSampling != 1 ||
        channel.channel().ySampling != 1)
      refuse(file, fmt::format("channel {} is of whole numbers or not there for every pixel", name));
    for (const char* component : kComponents)
      if (channels.findChannel(layer + component) == nullptr)
        refuse(file, fmt::format("channel {}{} is missing", layer, component));
    if (std::ranges::find(names, layer) == names.end()) names.push_back(layer);
  }
  if (std::ranges::find(names, "") == names.end()) refuse(file, "channel R is missing");
  return names;
}

/// An empty image of the data window's size.
LayeredImage sized_image(const std::filesystem::path& file, const Imf::Header& header, std::size_t bytes) {
  const auto& window = header.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (std::min(width, height) < 1 || std::max(width, height) > kLongestSide)
    refuse(file, fmt::format("{} x {} pixels: 1 to {} a side are read", width, height, kLongestSide));
  std::uint64_t channels = 0;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) ++channels;
  const std::uint64_t row = channels * static_cast<std::uint64_t>(width), most = densest(header) * bytes;
  if (row * static_cast<std::uint64_t>(height) > most ||
      row * rows_at_once(header) > std::max(most, kSmallBlock))
    refuse(file, fmt::format("{} bytes cannot hold {} channels of {} x {} pixels: the file is cut off or its "
                             "header wrong",
                             bytes, channels, width, height));
  LayeredImage image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  return image;
}

void read_pixels(const std::string& bytes, const std::vector<std::size_t>& masked,
                 const std::vector<std::string>& names, std::vector<std::vector<glm::vec3>>& values) {
  InputBytes stream(bytes, masked);
  Imf::InputFile input(stream);
  const auto& window = input.header().dataWindow();
  const auto row = sizeof(glm::vec3) * static_cast<std::size_t>(window.max.x - window.min.x + 1);
  Imf::FrameBuffer buffer;
  for (std::size_t layer = 0; layer < names.size(); ++layer)
    for (int c = 0; c < kChannels; ++c)
      buffer.insert(names[layer] + kComponents[c],
                    Imf::Slice::Make(Imf::FLOAT, &values[layer][0][c], window, sizeof(glm::vec3), row));
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
}

/// Runs what OpenEXR does; what it does not like is an InputError.
template <class Work>
auto reading(const std::filesystem::path& file, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse(file, std::string("cannot be read: ") + error.what());
  }
}

}  // namespace

LayeredImage exr_of_bytes(const std::filesystem::path& file, const std::string& bytes) {
  require_scan_lines(file, bytes);
  const std::vector<std::size_t> masked = places_to_mask(file, bytes);
  const Imf::Header header = reading(file, [&] { return read_header(bytes, masked); });
  LayeredImage image = sized_image(file, header, bytes.size());
  const std::vector<std::string> names = layer_names(file, header.channels());
  std::vector<std::vector<glm::vec3>> values(names.size(), std::vector<glm::vec3>(image.pixels()));
  reading(file, [&] { read_pixels(bytes, masked, names, values); });

  for (std::size_t layer = 0; layer < names.size(); ++layer) {
    // A layer's channels begin with its name and a dot.
    const std::string name = names[layer].substr(0, names[layer].size() - (names[layer].empty() ? 0 : 1));
    std::vector<Rgb>& pixels = image.layers[name];
    pixels.assign(values[layer].begin(), values[layer].end());
    const auto bad =
        std::ranges::find_if(pixels, [](const Rgb& v) { return !std::isfinite(v.r + v.g + v.b); });
    if (bad != pixels.end()) {
      const auto at = static_cast<std::size_t>(bad - pixels.begin());
      const auto width = static_cast<std::size_t>(image.width);
      refuse(file, fmt::format("pixel {},{} of channels {}R, G, B is not finite", at % width, at / width,
                               names[layer]));
    }
    values[layer] = {};
  }
  return image;
}

LayeredImage read_exr(const std::filesystem::path& file) {
  const std::optional<std::string> bytes = read_text_file(file);
  if (!bytes) throw input_error_at(file, 0, "there is no such file", kHint);
  return exr_of_bytes(file, *bytes);
}

}  // namespace fluxel
