/// Image files that are cut, changed, or say more than they hold: as a texture and as an argument of `diff`.
#include <fmt/format.h>

#include "scenes/image/image_io.h"
#include "tests/cli/program.h"
#include "tests/hostile/hostile_case.h"
#include "tests/scenes/gltf_text.h"

namespace quadrille::hostile {
namespace {

std::string png_of(std::uint32_t width, std::uint32_t height) {
  const tests::ScratchFolder folder;
  scenes::save_png((folder.path() / "a.png").string(),
                   {width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height, 99)});
  return folder.read("a.png");
}

std::string exr_of(std::uint32_t width, std::uint32_t height) {
  const tests::ScratchFolder folder;
  scenes::save_exr((folder.path() / "a.exr").string(),
                   {width, height, 3, std::vector<float>(std::size_t{3} * width * height, 0.5F)});
  return folder.read("a.exr");
}

/// A Radiance picture of 16x8 pixels, its rows packed.
std::string hdr() {
  std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n";
  for (int row = 0; row < 8; ++row) {
    file += std::string("\2\2\0\20", 4);
    for (const char value : {'\x80', '\x70', '\x60', '\x80'}) file += std::string("\x90") + value;
  }
  return file;
}

/// A JPEG header of this size and nothing behind it but the end.
std::string jpeg_header(unsigned width, unsigned height) {
  const auto byte = [](unsigned v) { return std::string(1, static_cast<char>(v & 255)); };
  return "\xff\xd8\xff\xc0" + byte(0) + byte(11) + byte(8) + byte(height >> 8) + byte(height) +
         byte(width >> 8) + byte(width) + byte(1) + byte(1) + byte(0x11) + byte(0) + "\xff\xda" + byte(0) +
         byte(8) + byte(1) + byte(1) + byte(0) + byte(0) + byte(63) + byte(0) + "\xff\xd9";
}

std::string big_endian(std::uint32_t v) {
  std::string out;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(v >> shift & 255);
  return out;
}

/// Pictures of all directions, cut, changed, and of shapes and values that are none.
void add_environments(Group& group) {
  const auto add = [&](const std::string& what, const std::string& bytes, const std::string& name,
                       Expect expect = Expect::kEither) {
    std::vector<std::string> arguments = render_arguments("builtin:triangle");
    arguments.insert(arguments.end(), {"--environment", name});
    const auto write = [=](const fs::path& folder) { write_file(folder / name, bytes); };
    group.cases.push_back({"environment: " + what, arguments, name, write, expect});
  };
  const std::string radiance = hdr(), exr = exr_of(16, 8), size = "-Y 8 +X 16";
  add("a .hdr file", radiance, "a.hdr", Expect::kRendered);
  add("an .exr file", exr, "a.exr", Expect::kRendered);
  add("a PNG by the name of a .hdr file", png_of(16, 8), "a.hdr");
  add("an .exr file that is not twice as wide as high", exr_of(16, 16), "a.exr", Expect::kRefused);
  add("text", "no picture", "a.hdr", Expect::kRefused);
  for (std::size_t at = 1; at < radiance.size(); at += 7)
    add(fmt::format("a .hdr file cut at byte {}", at), radiance.substr(0, at), "a.hdr");
  for (std::size_t at = 0; at < radiance.size(); at += 3) {
    std::string bad = radiance;
    bad[at] = static_cast<char>(bad[at] ^ 0x55);
    add(fmt::format("a .hdr file with byte {} changed", at), bad, "a.hdr");
  }
  for (std::size_t at = 9; at < exr.size(); at += 23) {
    std::string bad = exr;
    bad[at] = static_cast<char>(bad[at] ^ 0x7f);
    add(fmt::format("an .exr file with byte {} changed", at), bad, "a.exr");
  }
  for (const char* other : {"-Y 4000 +X 8000", "-Y 99999999999999999999 +X 2", "+X 16 -Y 8", "-Y -8 +X 16",
                            "-Y 0 +X 0", "-Y 8 +X 16 1", "-Y 16384 +X 16384"}) {
    std::string bad = radiance;
    bad.replace(bad.find(size), size.size(), other);
    add(fmt::format("a .hdr file of '{}'", other), bad, "a.hdr", Expect::kRefused);
  }
  add("a .hdr file without an end of its text", "#?RADIANCE\n" + std::string(100000, 'a'), "a.hdr",
      Expect::kRefused);
  add("a .hdr file of lines", "#?RADIANCE\n" + repeated("a=b\n", 100000), "a.hdr", Expect::kRefused);
}

std::string textured(const std::string& image) {
  return scenes::triangle_gltf(
      R"(,"material":0)",
      R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],"images":[)" +
          image + "]");
}

}  // namespace

Group image_cases() {
  Group group{"images", "cut, changed, and with headers that say more than there is", {}};
  const auto add = [&](const std::string& what, const std::string& bytes, const std::string& name = "a.png",
                       Expect expect = Expect::kEither) {
    const auto write = [=](const fs::path& folder) { write_file(folder / name, bytes); };
    group.cases.push_back({what, {"diff", name, name}, name, write, expect});
  };
  const std::string png = png_of(5, 4), exr = exr_of(5, 4);
  add("a PNG itself", png, "a.png", Expect::kRendered);
  add("an EXR itself", exr, "a.exr", Expect::kRendered);
  add("a PNG by the name of a JPEG", png, "a.jpg", Expect::kRendered);
  add("empty", "", "a.png", Expect::kRefused);
  add("text", "no picture", "a.png", Expect::kRefused);
  for (const std::string& name : {std::string("a.tiff"), std::string("a.mp4"), std::string("a.svg")})
    add("text named " + name, "no picture", name, Expect::kRefused);
  for (std::size_t size = 1; size < png.size(); size += 9)
    add(fmt::format("a PNG cut at byte {}", size), png.substr(0, size), "a.png", Expect::kRefused);
  for (std::size_t size = 1; size < exr.size(); size += 17)
    add(fmt::format("an EXR cut at byte {}", size), exr.substr(0, size), "a.exr");
  for (std::size_t i = 0; i < png.size(); i += 5) {
    std::string bad = png;
    bad[i] = static_cast<char>(bad[i] ^ 0x40);
    add(fmt::format("a PNG with byte {} changed", i), bad);
  }
  for (std::size_t i = 4; i < exr.size(); i += 11) {
    std::string bad = exr;
    bad[i] = static_cast<char>(bad[i] ^ 0x7f);
    add(fmt::format("an EXR with byte {} changed", i), bad, "a.exr");
  }
  for (const std::uint32_t side : {0U, 16385U, 65535U, 0x7fffffffU, 0xffffffffU})
    add(fmt::format("a PNG of {0}x{0} by its header", side),
        png.substr(0, 16) + big_endian(side) + big_endian(side) + png.substr(24), "a.png", Expect::kRefused);
  for (const unsigned side : {0U, 1U, 4000U, 65535U})
    add(fmt::format("a JPEG of {0}x{0} without data", side), jpeg_header(side, side), "a.jpg");
  add("a PNG bomb of 8192x8192", png_of(8192, 8192));
  group.cases.push_back({"a folder",
                         {"diff", "a.png", "a.png"},
                         "a.png",
                         [](const fs::path& f) { fs::create_directory(f / "a.png"); },
                         Expect::kRefused});
  const auto scene = [&](const std::string& what, const std::string& image, const std::string& bytes,
                         Expect expect = Expect::kRefused) {
    Case c = scene_case("texture: " + what, textured(image), "t.gltf", expect);
    const auto write = c.prepare;
    c.prepare = [=](const fs::path& folder) { write(folder), write_file(folder / "a.png", bytes); };
    group.cases.push_back(std::move(c));
  };
  add_environments(group);
  const std::string file = R"({"uri":"a.png"})";
  scene("a PNG", file, png, Expect::kRendered);
  scene("cut", file, png.substr(0, png.size() / 2));
  scene("empty", file, "");
  scene("an EXR", file, exr, Expect::kEither);
  scene("missing", R"({"uri":"b.png"})", png);
  scene("a folder", R"({"uri":"."})", png);
  scene("a device", R"({"uri":"/dev/zero"})", png);
  scene("no bufferView", R"({"bufferView":9,"mimeType":"image/png"})", png);
  scene("geometry as pixels", R"({"bufferView":0,"mimeType":"image/png"})", png);
  scene("nothing", "{}", png);
  scene("damaged data", R"({"uri":"data:image/png;base64,iVBORw0KGgo="})", png);
  std::string bombs = file;
  for (int i = 1; i < 40; ++i) bombs += "," + file;
  std::string materials, textures, primitives;
  for (int i = 0; i < 40; ++i) {
    const char* const comma = i > 0 ? "," : "";
    materials +=
        fmt::format("{}{{\"pbrMetallicRoughness\":{{\"baseColorTexture\":{{\"index\":{}}}}}}}", comma, i);
    textures += fmt::format("{}{{\"source\":{}}}", comma, i);
    primitives += fmt::format("{}{{\"attributes\":{{\"POSITION\":0}},\"material\":{}}}", comma, i);
  }
  std::string text = textured(bombs);
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})", materials);
  replace(R"({"source":0})", textures);
  replace(R"({"attributes":{"POSITION":0},"material":0})", primitives);
  group.cases.push_back(scene_case("forty textures that unpack a thousandfold", text));
  const auto write = group.cases.back().prepare;
  const std::string bomb = png_of(4096, 4096);
  group.cases.back().prepare = [=](const fs::path& folder) {
    write(folder), write_file(folder / "a.png", bomb);
  };
  return group;
}

}  // namespace quadrille::hostile
