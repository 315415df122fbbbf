/// OpenImageIO behind the three functions of image_module.h. Nothing is thrown across that border.
#include "scenes/image/image_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <webp/decode.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace {

// One thread a call: the caller decodes several images at once.
void configure() {
  static const bool done = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
  (void)done;
}

bool fail(QuadrilleImage& result, const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  std::memset(result.error, 0, sizeof(result.error));
  line.copy(result.error, sizeof(result.error) - 1);
  return false;
}

bool allocate(QuadrilleImage& result, std::size_t size) {
  result.size = size;
  result.data = std::malloc(size);
  return result.data != nullptr || fail(result, "out of memory");
}

/// Grey to r=g=b, missing alpha to 255; pixels arrive with `channels` bytes each.
void widen_to_rgba(const std::vector<std::uint8_t>& in, std::size_t channels, std::uint8_t* out) {
  const bool color = channels >= 3;
  for (std::size_t i = 0, o = 0; i + channels <= in.size(); i += channels, o += 4) {
    out[o] = in[i];
    out[o + 1] = color ? in[i + 1] : in[i];
    out[o + 2] = color ? in[i + 2] : in[i];
    out[o + 3] = channels == 4 ? in[i + 3] : channels == 2 ? in[i + 1] : std::uint8_t{255};
  }
}

/// A file in memory of which nothing before its beginning or behind its end can be read. OpenImageIO's own
/// reader takes any place that a file names.
class FileInMemory : public OIIO::Filesystem::IOMemReader {
 public:
  using IOMemReader::IOMemReader;
  bool seek(std::int64_t offset) override { return lies_within(offset) && IOMemReader::seek(offset); }
  std::size_t read(void* buffer, std::size_t count) override {
    const std::size_t done = pread(buffer, count, m_pos);
    m_pos += static_cast<std::int64_t>(done);
    return done;
  }
  std::size_t pread(void* buffer, std::size_t count, std::int64_t offset) override {
    if (!lies_within(offset)) return 0;
    const std::size_t done = std::min(count, size() - static_cast<std::size_t>(offset));
    if (done > 0) std::memcpy(buffer, m_buf.data() + offset, done);
    return done;
  }

 private:
  [[nodiscard]] bool lies_within(std::int64_t offset) const {
    return offset >= 0 && static_cast<std::size_t>(offset) <= size();
  }
};

/// While any thread decodes, standard error leads nowhere: libpng and others print lines of their own about
/// damaged files, and our caller prints its own.
class QuietErrors {
 public:
  QuietErrors() {
    const std::scoped_lock lock(mutex_);
    if (users_++ > 0) return;
    std::fflush(stderr);
    kept_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (kept_ >= 0 && nowhere >= 0) dup2(nowhere, STDERR_FILENO);
    if (nowhere >= 0) close(nowhere);
  }
  ~QuietErrors() {
    const std::scoped_lock lock(mutex_);
    if (--users_ > 0 || kept_ < 0) return;
    std::fflush(stderr);
    dup2(kept_, STDERR_FILENO);
    close(kept_);
  }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  static inline std::mutex mutex_;
  static inline int users_ = 0, kept_ = -1;
};

bool read_bytes(OIIO::ImageInput& input, QuadrilleImage& result) {
  const std::size_t channels = std::min(result.channels, 4U),
                    pixels = std::size_t{result.width} * result.height;
  if (!allocate(result, 4 * pixels)) return false;
  std::vector<std::uint8_t> narrow(channels < 4 ? channels * pixels : 0);
  void* const to = channels < 4 ? narrow.data() : result.data;
  if (!input.read_image(0, 0, 0, static_cast<int>(channels), OIIO::TypeDesc::UINT8, to)) {
    std::free(result.data);
    result.data = nullptr;
    return fail(result, input.geterror());
  }
  if (channels < 4) widen_to_rgba(narrow, channels, static_cast<std::uint8_t*>(result.data));
  result.channels = 4;
  return true;
}

bool read_floats(OIIO::ImageInput& input, QuadrilleImage& result) {
  if (!allocate(result, sizeof(float) * result.width * result.height * result.channels)) return false;
  return input.read_image(0, 0, 0, static_cast<int>(result.channels), OIIO::TypeDesc::FLOAT, result.data) ||
         fail(result, input.geterror());
}

/// Is it a still WebP image with alpha? OpenImageIO's reader multiplies the colours of such a one by its
/// alpha, whatever it is asked for.
bool is_webp_with_alpha(const void* bytes, std::size_t size, const char* format) {
  WebPBitstreamFeatures features;
  return std::strcmp(format, "webp") == 0 &&
         WebPGetFeatures(static_cast<const std::uint8_t*>(bytes), size, &features) == VP8_STATUS_OK &&
         features.has_alpha != 0 && features.has_animation == 0;
}

bool decode_webp(const void* bytes, std::size_t size, std::uint64_t max_bytes, QuadrilleImage& result) {
  const auto* data = static_cast<const std::uint8_t*>(bytes);
  int width = 0, height = 0;
  if (WebPGetInfo(data, size, &width, &height) == 0) return fail(result, "it is not a picture");
  const std::uint64_t out_bytes =
      std::uint64_t{4} * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (out_bytes > max_bytes)
    return fail(result, "its pixels take more than " + std::to_string(max_bytes) + " bytes");
  if (!allocate(result, out_bytes)) return false;
  if (WebPDecodeRGBAInto(data, size, static_cast<std::uint8_t*>(result.data), out_bytes, 4 * width) ==
      nullptr) {
    std::free(result.data);
    result.data = nullptr;
    return fail(result, "it is damaged");
  }
  result.width = static_cast<std::uint32_t>(width);
  result.height = static_cast<std::uint32_t>(height);
  result.channels = 4;
  return true;
}

/// OpenImageIO tries a file's first bytes before it opens it, and its DDS reader then does not go back: that
/// one is named instead. One file is opened at a time: while OpenImageIO 2.4 reads a colour profile, it
/// writes to a table that all threads share. Pixels are decoded outside of the lock.
std::unique_ptr<OIIO::ImageInput> open_input(const std::string& format, const OIIO::ImageSpec& config,
                                             OIIO::Filesystem::IOProxy* proxy, std::string& error) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  if (format != "dds") {
    auto input = OIIO::ImageInput::open("image." + format, &config, proxy);
    if (!input) error = OIIO::geterror();
    return input;
  }
  auto input = OIIO::ImageInput::create(format);
  OIIO::ImageSpec spec;
  if (input && input->open("image." + format, spec, config)) return input;
  error = input ? input->geterror() : OIIO::geterror();
  return nullptr;
}

bool decode(const void* bytes, std::size_t size, const char* format, bool as_float, std::uint64_t max_bytes,
            QuadrilleImage& result) {
  configure();
  const QuietErrors quiet;
  if (!as_float && is_webp_with_alpha(bytes, size, format))
    return decode_webp(bytes, size, max_bytes, result);
  FileInMemory memory(const_cast<void*>(bytes), size);
  OIIO::Filesystem::IOProxy* proxy = &memory;
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, static_cast<void*>(&proxy));
  std::string error;
  const auto input = open_input(format, config, proxy, error);
  if (!input) return fail(result, error);
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
    return fail(result, "it is not a picture");
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
  const std::uint64_t pixel_bytes = as_float ? sizeof(float) * static_cast<std::uint64_t>(spec.nchannels) : 4;
  if (pixels > max_bytes / pixel_bytes) {
    return fail(result, "its " + std::to_string(pixels) + " pixels of " + std::to_string(spec.nchannels) +
                            " channels take more than " + std::to_string(max_bytes) + " bytes");
  }
  result.width = static_cast<std::uint32_t>(spec.width);
  result.height = static_cast<std::uint32_t>(spec.height);
  result.channels = static_cast<std::uint32_t>(spec.nchannels);
  return as_float ? read_floats(*input, result) : read_bytes(*input, result);
}

/// A picture's bytes are its own: OpenImageIO writes today's date into an .exr file that names none.
constexpr const char* kNoDate = "1970:01:01 00:00:00";

OIIO::ImageSpec output_spec(std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                            bool as_float) {
  OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels),
                       as_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  if (as_float && channels == 1) spec.channelnames = {"Z"};
  if (as_float) {
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", kNoDate);
  } else {
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("png:compressionLevel", 4);
  }
  return spec;
}

bool encode(const void* pixels, std::uint32_t width, std::uint32_t height, std::uint32_t channels,
            bool as_float, QuadrilleImage& result) {
  configure();
  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput memory(file);
  const char* name = as_float ? "image.exr" : "image.png";
  const auto output = OIIO::ImageOutput::create(name, &memory);
  if (!output) return fail(result, OIIO::geterror());
  const OIIO::ImageSpec spec = output_spec(width, height, channels, as_float);
  if (!output->open(name, spec) || !output->write_image(spec.format, pixels) || !output->close())
    return fail(result, output->geterror());
  if (!allocate(result, file.size())) return false;
  std::memcpy(result.data, file.data(), file.size());
  return true;
}

template <class Call>
bool guarded(QuadrilleImage* result, const Call& call) {
  *result = {};
  bool done = false;
  try {
    done = call();
  } catch (const std::exception& error) { done = fail(*result, error.what()); }
  if (!done) {
    std::free(result->data);
    result->data = nullptr;
  }
  return done;
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) bool quadrille_images_decode(const void* bytes, std::size_t size,
                                                                    const char* format, bool as_float,
                                                                    std::uint64_t max_bytes,
                                                                    QuadrilleImage* result) {
  return guarded(result, [&] { return decode(bytes, size, format, as_float, max_bytes, *result); });
}

__attribute__((visibility("default"))) bool quadrille_images_encode(const void* pixels, std::uint32_t width,
                                                                    std::uint32_t height,
                                                                    std::uint32_t channels, bool as_float,
                                                                    QuadrilleImage* result) {
  return guarded(result, [&] { return encode(pixels, width, height, channels, as_float, *result); });
}

__attribute__((visibility("default"))) void quadrille_images_free(void* data) { std::free(data); }

}  // extern "C"
