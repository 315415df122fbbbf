/// Errors by hand-made figures, and a whole study of a small scene.
#include "studies/accuracy_report.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

#include "scenes/scene.h"
#include "studies/plot.h"

namespace quadrille::studies {
namespace {

using Catch::Matchers::Contains;
using nlohmann::json;

MachineCost small_cost() {
  return {1000, {{"core_0", 90}, {"rop_0", 10}, {"l2_0", 50}}, {{"texture", 4000}, {"color", 100}}, 2000};
}

StudyScene scene_of(const std::string& name, std::uint32_t width, std::uint32_t height) {
  scenes::SceneOptions options;
  options.width = width;
  options.height = height;
  StudyScene scene{name, scenes::load_scene(name, options), std::nullopt};
  options.visibility = true;
  scene.visibility = scenes::load_scene(name, options);
  return scene;
}

TEST_CASE("accuracy: a run has no error against itself") {
  const CostError error = cost_error(small_cost(), small_cost());
  CHECK(error.cycles_percent == 0);
  CHECK(error.busy_mean_points == 0);
  CHECK(error.busy_max_points == 0);
  CHECK(error.memory_percent == 0);
  CHECK(error.client_max_percent == 0);
  CHECK(error.worst_unit.empty());
  CHECK(error.worst_client.empty());
}

TEST_CASE("accuracy: errors are those of figures made by hand") {
  MachineCost other = small_cost();
  other.cycles = 1100;
  other.units[1].percent = 4;   // 6 points below
  other.units[2].percent = 53;  // 3 points above
  other.memory_bytes = 1500;
  other.clients[0].bytes = 3960;
  other.clients[1].bytes = 105;
  const CostError error = cost_error(small_cost(), other);
  CHECK(error.cycles_percent == Approx(10));
  CHECK(error.busy_mean_points == Approx(3));
  CHECK(error.busy_max_points == Approx(6));
  CHECK(error.worst_unit == "rop_0");
  CHECK(error.memory_percent == Approx(-25));
  CHECK(error.client_max_percent == Approx(5));
  CHECK(error.worst_client == "color");
}

TEST_CASE("accuracy: an error against nothing is infinite unless there is nothing in both") {
  CHECK(relative_percent(0, 0) == 0);
  CHECK(std::isinf(relative_percent(0, 3)));
  CHECK(relative_percent(4, 3) == Approx(-25));
}

TEST_CASE("accuracy: a picture's error counts colours and leaves out what it is told to") {
  const std::vector<std::uint32_t> ideal{0xff000000u, 0xff102030u, 0xff000000u, 0x00ffffffu};
  std::vector<std::uint32_t> image = ideal;
  CHECK(image_error(image, ideal).rmse == 0);
  CHECK(std::isinf(image_error(image, ideal).psnr_db));
  image[3] = 0xffffffffu;  // alpha alone
  CHECK(image_error(image, ideal).max == 0);
  image[0] = 0xff000003u;  // red off by 3
  image[1] = 0xff112030u;  // blue off by 1
  const ImageError error = image_error(image, ideal);
  CHECK(error.rmse == Approx(std::sqrt((9.0 + 1.0) / 12.0)));
  CHECK(error.max == 3);
  CHECK(error.within_1_percent == Approx(75));
  CHECK(error.within_2_percent == Approx(75));
  const ImageError part = image_error(image, ideal, std::vector<std::uint8_t>{1, 0, 0, 0});
  CHECK(part.pixels == 3);
  CHECK(part.max == 1);
  CHECK(part.rmse == Approx(std::sqrt(1.0 / 9.0)));
}

TEST_CASE(
    "accuracy: a study of a small scene: one picture, exact without error, errors that fall as bits rise") {
  AccuracyOptions options;
  options.windows = {16, 4096};
  options.repeat = 2;
  std::size_t steps = 0;
  options.progress = [&](const std::string& what) { steps += what.starts_with("builtin:quad: ") ? 1 : 0; };
  const pipeline::MachineConfig machine;
  const SceneAccuracy result = measure_accuracy(scene_of("builtin:quad", 48, 32), machine, options);
  CHECK(steps >= 2 * (4 + 25));
  CHECK((result.width == 48 && result.height == 32));

  REQUIRE(result.settings.size() == 4);
  CHECK(result.settings[0].setting.name() == "functional");
  CHECK_FALSE(result.settings[0].cost);
  CHECK_FALSE(result.settings[0].error);
  CHECK(result.settings[1].setting.name() == "exact");
  CHECK(result.settings[1].speed_up == Approx(1));
  REQUIRE(result.settings[1].error);
  CHECK(result.settings[1].error->cycles_percent == 0);
  CHECK(result.settings[1].error->busy_max_points == 0);
  CHECK(result.settings[3].setting.name() == "window 4096");
  REQUIRE(result.images.size() == 1);
  for (const SettingResult& s : result.settings) {
    CHECK(s.image == 0);
    CHECK(s.cpu_s.size() == 2);
    CHECK(s.wall_s.size() == 2);
    if (s.cost) CHECK(s.cost->cycles > 0);
  }

  REQUIRE(result.precision.size() == 9 + 8 + 8);
  CHECK((result.precision.front().parameter == "subpixel_bits" && result.precision.front().bits == 4));
  CHECK((result.precision.back().parameter == "lod_bits" && result.precision.back().bits == 8));
  for (const PrecisionResult& p : result.precision) {
    REQUIRE(p.same_triangle);
    CHECK(p.same_triangle->pixels <= p.all.pixels);
    if (p.bits == 8) CHECK(p.all.rmse == result.images[0].rmse);  // the machine's own precision
  }
  const auto& coarse_texels = *result.precision[9].same_triangle;
  const auto& fine_texels = *result.precision[16].same_triangle;
  CHECK(coarse_texels.rmse > fine_texels.rmse);

  const std::string table = accuracy_table(result, machine);
  for (const char* word : {"ACCURACY  builtin:quad, 48x32", "functional", "window 4096", "approximate",
                           "PICTURE", "PRECISION", "subtexel_bits"})
    CHECK_THAT(table, Contains(word));
  CHECK_THAT(table, !Contains("DIFFERS"));

  const json document = json::parse(accuracy_json({&result, 1}, machine));
  CHECK(document.at("schema") == kAccuracySchema);
  CHECK(document.at("machine").at("parameters").at("gpu.cores") == 4);
  const json& scene = document.at("scenes").at(0);
  CHECK(scene.at("settings").size() == 4);
  CHECK(scene.at("settings").at(0).at("window_cycles").is_null());
  CHECK(scene.at("settings").at(0).at("figures").is_null());
  CHECK(scene.at("settings").at(1).at("error").at("cycles_percent") == 0);
  CHECK(scene.at("settings").at(1).at("approximate") == false);
  CHECK(scene.at("settings").at(2).at("approximate") == true);
  CHECK(scene.at("settings").at(2).at("cpu_s").at("runs").size() == 2);
  CHECK(scene.at("settings").at(2).at("figures").at("busy_percent").contains("gpu.core_0") ==
        scene.at("settings").at(1).at("figures").at("busy_percent").contains("gpu.core_0"));
  CHECK(scene.at("precision").size() == 25);

  CHECK_THAT(accuracy_plot({&result, 1}), Contains("builtin:quad") && Contains("4096"));
}

TEST_CASE("accuracy: the study refuses what a run refuses") {
  pipeline::MachineConfig machine;
  machine.set("core.register_rows", "16", "test");
  AccuracyOptions options;
  options.repeat = 1;
  CHECK_THROWS_WITH(measure_accuracy(scene_of("builtin:cubes", 16, 16), machine, options),
                    Contains("builtin:cubes: exact: ") && Contains("register_rows"));
}

TEST_CASE("plots: text is quoted so that gnuplot reads none of it") {
  CHECK(quoted("plain") == "\"plain\"");
  CHECK_THAT(quoted("a\"b"), Contains("\\\""));
  CHECK(quoted("two\nlines") == "\"two lines\"");
}

}  // namespace
}  // namespace quadrille::studies
