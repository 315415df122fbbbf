/// --color-format and --depth-format: what is refused, and what pictures in other formats have in common.
#include "tests/cli/quadrille.h"

using namespace quadrille::tests;

namespace {

/// The picture of builtin:cubes with these formats, as `name`.
void draw(const ScratchFolder& folder, const std::string& name, const std::vector<std::string>& formats) {
  std::vector<std::string> arguments{"render", "builtin:cubes", "--size", "64x36", "-q", "--out", name};
  arguments.insert(arguments.end(), formats.begin(), formats.end());
  const ProgramRun done = run_quadrille(folder, arguments);
  CAPTURE(arguments, done.err);
  REQUIRE(done.exit_code == 0);
}

int within(const ScratchFolder& folder, const std::string& a, const std::string& b,
           const std::string& units) {
  return run_quadrille(folder, {"diff", a, b, "--max-lsb", units}).exit_code;
}

}  // namespace

TEST_CASE("formats: others are refused with those that there are") {
  refused({"render", "builtin:cubes", "--color-format", "R8G8B8", "--out", "a.png"},
          {"--color-format", "R16G16B16A16_SFLOAT"});
  refused({"render", "builtin:cubes", "--color-format", "D16_UNORM", "--out", "a.png"}, {"--color-format"});
  refused({"render", "builtin:cubes", "--depth-format", "R8_UNORM", "--out", "a.png"},
          {"--depth-format", "D24_UNORM_S8_UINT"});
  refused({"render", "builtin:cubes", "--view", "uv", "--color-format", "R8_UNORM", "--out", "a.png"},
          {"--color-format", "--view"});
}

TEST_CASE("formats: a picture of linear halves is the sRGB picture, and depths of 24 bits hide the same") {
  const ScratchFolder folder;
  draw(folder, "a.png", {});
  draw(folder, "b.png", {"--color-format", "R16G16B16A16_SFLOAT", "--depth-format", "D24_UNORM_S8_UINT"});
  draw(folder, "c.png", {"--color-format", "R32G32B32A32_SFLOAT", "--samples", "4"});
  draw(folder, "d.png", {"--samples", "4"});
  CHECK(within(folder, "a.png", "b.png", "1") == 0);
  CHECK(within(folder, "d.png", "c.png", "2") == 0);  // samples are rounded to 8 bits before their mean in d
}
