#include "image/exr_writer.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "core/file.hpp"

namespace fluxel {

namespace {

/// OpenEXR swallows write errors when it closes a file, so it writes to memory, and the bytes are checked on
/// their way to the disk.
class OutputBytes final : public Imf::OStream {
 public:
  OutputBytes() : Imf::OStream("memory") {}

  void write(const char chars[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (bytes_.size() < position_ + size) bytes_.resize(position_ + size);
    std::memcpy(bytes_.data() + position_, chars, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

/// The header's channels and where their values lie; the values of the float channels are kept here.
struct Channels {
  Imf::Header& header;
  Imf::FrameBuffer buffer{};
  std::map<std::string, std::vector<float>> values{};

  template <class T>
  void insert(const std::string& name, Imf::PixelType type, const T* first) {
    // OpenEXR reads through this pointer only; its type is for reading files too.
    auto* base = const_cast<char*>(reinterpret_cast<const char*>(first));
    const auto row = sizeof(T) * static_cast<std::size_t>(header.dataWindow().max.x + 1);
    header.channels().insert(name, Imf::Channel(type));
    buffer.insert(name, Imf::Slice(type, base, sizeof(T), row));
  }

  template <class Vec>
  void insert_components(const std::string& layer, const char* components, const std::vector<Vec>& vectors) {
    for (int c = 0; c < 3; ++c) {
      const std::string name = layer + components[c];
      std::vector<float>& channel = values[name];
      channel.reserve(vectors.size());
      for (const Vec& vector : vectors) channel.push_back(static_cast<float>(vector[c]));
      insert(name, Imf::FLOAT, channel.data());
    }
  }
};

Imf::Header make_header(int width, int height, const std::map<std::string, std::string>& attributes) {
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, text] : attributes) header.insert(name, Imf::StringAttribute(text));
  return header;
}

void write_file(const std::filesystem::path& file, const Channels& channels) {
  OutputBytes stream;
  {
    Imf::OutputFile output(stream, channels.header);
    output.setFrameBuffer(channels.buffer);
    output.writePixels(channels.header.dataWindow().max.y + 1);
  }  // the table of offsets is written when the file is closed
  write_bytes_atomically(file, stream.bytes());
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Picture& picture,
               const std::map<std::string, std::string>& attributes) {
  Imf::Header header = make_header(picture.width, picture.height, attributes);
  Channels channels{header};
  channels.insert_components("", "RGB", picture.radiance);
  channels.insert("element.id", Imf::UINT, picture.element.data());
  channels.insert("depth.Z", Imf::FLOAT, picture.depth.data());
  channels.insert_components("normal.", "XYZ", picture.normal);
  channels.insert_components("reflectance.", "RGB", picture.reflectance);
  channels.insert_components("irradiance.", "RGB", picture.irradiance);
  write_file(file, channels);
}

void write_exr(const std::filesystem::path& file, const LayeredImage& image,
               const std::map<std::string, std::string>& attributes) {
  Imf::Header header = make_header(image.width, image.height, attributes);
  Channels channels{header};
  for (const auto& [name, values] : image.layers) {
    if (values.size() != image.pixels())
      throw std::logic_error("write_exr: layer '" + name + "' has not one value a pixel");
    channels.insert_components(name.empty() ? "" : name + ".", "RGB", values);
  }
  write_file(file, channels);
}

}  // namespace fluxel
