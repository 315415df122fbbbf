/// libpng and libjpeg-turbo, which leave by `longjmp` when they fail: what has a destructor lives outside of
/// the functions that they leave.
#include "scenes/image/plain_image.h"

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include <jpeglib.h>  // after <cstdio>, whose types it uses
#include <png.h>
#include <zlib.h>

namespace quadrille::scenes {
namespace {

constexpr std::size_t kRgba = 4;

// ---- PNG ----

/// A chunk that says nothing about pixels as they are stored, and that many files have in a form that libpng
/// warns about.
constexpr png_byte kColorProfile[] = "iCCP";

void png_fails(png_structp png, png_const_charp /*text*/) { png_longjmp(png, 1); }

struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::span<const std::byte> rest;
  bool warned = false;

  explicit PngReader(std::span<const std::byte> bytes) : rest(bytes) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, png_fails,
                                 [](png_structp p, png_const_charp /*text*/) {
                                   static_cast<PngReader*>(png_get_error_ptr(p))->warned = true;
                                 });
    if (png != nullptr) info = png_create_info_struct(png);
  }
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  static void take(png_structp png, png_bytep to, std::size_t size) {
    auto& self = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (size > self.rest.size()) png_error(png, "truncated");
    std::memcpy(to, self.rest.data(), size);
    self.rest = self.rest.subspan(size);
  }
};

/// Reads into 4 * width * height bytes. False for an unusual or damaged file.
bool read_png(PngReader& reader, const ImageHeader& header, std::uint8_t* pixels) {
  const png_structp png = reader.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &reader, PngReader::take);
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, kColorProfile, 1);
  png_read_info(png, reader.info);
  const bool usual = png_get_image_width(png, reader.info) == header.width &&
                     png_get_image_height(png, reader.info) == header.height &&
                     png_get_bit_depth(png, reader.info) <= 8 &&
                     png_get_interlace_type(png, reader.info) == PNG_INTERLACE_NONE;
  if (!usual) return false;
  png_set_expand(png);  // palettes to colours, small greys to bytes, a transparent colour to alpha
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
  png_read_update_info(png, reader.info);
  if (png_get_rowbytes(png, reader.info) != kRgba * header.width) return false;
  for (std::uint32_t y = 0; y < header.height; ++y)
    png_read_row(png, pixels + kRgba * header.width * y, nullptr);
  png_read_end(png, nullptr);
  return !reader.warned;
}

std::optional<Rgba8Image> decode_png(std::span<const std::byte> bytes, const ImageHeader& header) {
  PngReader reader(bytes);
  if (reader.info == nullptr) return std::nullopt;
  Rgba8Image image{header.width, header.height,
                   std::vector<std::uint8_t>(kRgba * header.width * header.height)};
  if (!read_png(reader, header, image.pixels.data())) return std::nullopt;
  return image;
}

struct PngWriter {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::vector<std::byte> file;

  PngWriter() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, png_fails,
                                  [](png_structp /*png*/, png_const_charp /*text*/) {});
    if (png != nullptr) info = png_create_info_struct(png);
  }
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  static void put(png_structp png, png_bytep data, std::size_t size) {
    auto& file = static_cast<PngWriter*>(png_get_io_ptr(png))->file;
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    file.insert(file.end(), bytes, bytes + size);
  }
};

bool write_png(PngWriter& writer, const Rgba8Image& image) {
  constexpr int kCompressionLevel = 4;
  const png_structp png = writer.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &writer, PngWriter::put, nullptr);
  png_set_compression_level(png, kCompressionLevel);
  png_set_compression_strategy(png, Z_DEFAULT_STRATEGY);
  png_set_IHDR(png, writer.info, image.width, image.height, 8, PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_oFFs(png, writer.info, 0, 0, PNG_OFFSET_PIXEL);
  png_set_sRGB_gAMA_and_cHRM(png, writer.info, PNG_sRGB_INTENT_ABSOLUTE);
  char key[] = "oiio:ColorSpace", value[] = "sRGB";
  png_text text{};
  text.compression = PNG_TEXT_COMPRESSION_NONE;
  text.key = key;
  text.text = value;
  text.text_length = sizeof(value) - 1;
  png_set_text(png, writer.info, &text, 1);
  png_write_info(png, writer.info);
  for (std::uint32_t y = 0; y < image.height; ++y)
    png_write_row(png, image.pixels.data() + kRgba * image.width * y);
  png_write_end(png, writer.info);
  return true;
}

// ---- JPEG ----

struct JpegReader {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  std::jmp_buf failed{};

  JpegReader() {
    jpeg.err = jpeg_std_error(&errors);
    errors.error_exit = [](j_common_ptr common) {
      std::longjmp(static_cast<JpegReader*>(common->client_data)->failed, 1);
    };
    errors.output_message = [](j_common_ptr /*common*/) {};
    jpeg.client_data = this;
  }
  ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
};

/// As `read_png`.
bool read_jpeg(JpegReader& reader, std::span<const std::byte> bytes, const ImageHeader& header,
               std::uint8_t* pixels) {
  jpeg_decompress_struct& jpeg = reader.jpeg;
  if (setjmp(reader.failed) != 0) return false;
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  const J_COLOR_SPACE space = jpeg.jpeg_color_space;
  const bool usual = jpeg.image_width == header.width && jpeg.image_height == header.height &&
                     jpeg.data_precision == 8 &&
                     (space == JCS_GRAYSCALE || space == JCS_YCbCr || space == JCS_RGB);
  if (!usual) return false;
  jpeg.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&jpeg);
  while (jpeg.output_scanline < header.height) {
    JSAMPROW row = pixels + kRgba * header.width * jpeg.output_scanline;
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return reader.errors.num_warnings == 0;
}

std::optional<Rgba8Image> decode_jpeg(std::span<const std::byte> bytes, const ImageHeader& header) {
  JpegReader reader;
  Rgba8Image image{header.width, header.height,
                   std::vector<std::uint8_t>(kRgba * header.width * header.height)};
  if (!read_jpeg(reader, bytes, header, image.pixels.data())) return std::nullopt;
  return image;
}

}  // namespace

std::optional<Rgba8Image> decode_plain_image(std::span<const std::byte> bytes, const ImageHeader& header) {
  if (header.format == ImageFormat::kPng) return decode_png(bytes, header);
  if (header.format == ImageFormat::kJpeg) return decode_jpeg(bytes, header);
  return std::nullopt;
}

std::optional<std::vector<std::byte>> encode_plain_png(const Rgba8Image& image) {
  PngWriter writer;
  if (writer.info == nullptr || !write_png(writer, image)) return std::nullopt;
  return std::move(writer.file);
}

}  // namespace quadrille::scenes
