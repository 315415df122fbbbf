/// Names that were meant.
#include "models/base/near_name.h"

#include <catch2/catch.hpp>

using namespace quadrille;

namespace {

const std::vector<std::string> kNames{"gpu.cores",       "gpu.channels", "texture.cache_lines",
                                      "rop.cache_lines", "render",       "describe"};

}  // namespace

TEST_CASE("near_name: distances count letters put in, left out, changed, and neighbours swapped") {
  CHECK(letters_apart("", "") == 0);
  CHECK(letters_apart("", "abc") == 3);
  CHECK(letters_apart("rende", "render") == 1);
  CHECK(letters_apart("redner", "render") == 1);
  CHECK(letters_apart("RENDER", "render") == 0);
  CHECK(letters_apart("kitten", "sitting") == 3);
  CHECK(letters_apart("ab", "ba") == 1);
  CHECK(letters_apart("abc", "ca") == 3);  // a swap's letters are not moved again
}

TEST_CASE("near_name: the nearest name is offered, and none that is far") {
  CHECK(near_names("rende", kNames) == std::vector<std::string>{"render"});
  CHECK(near_names("gpu.croes", kNames) == std::vector<std::string>{"gpu.cores"});
  CHECK(near_names("texture.cachelines", kNames) == std::vector<std::string>{"texture.cache_lines"});
  CHECK(near_names("bicycle", kNames).empty());
  CHECK(near_names("", kNames).empty());
  CHECK(near_names(std::string(100000, 'a'), kNames).empty());
}

TEST_CASE("near_name: what was left out before a dot is found, all of it") {
  CHECK(near_names("cores", kNames) == std::vector<std::string>{"gpu.cores"});
  CHECK(near_names("cache_line", kNames) ==
        std::vector<std::string>{"texture.cache_lines", "rop.cache_lines"});
  CHECK(did_you_mean("cache_line", kNames) == "; did you mean 'texture.cache_lines' or 'rop.cache_lines'?");
  CHECK(did_you_mean("bicycle", kNames).empty());
}
