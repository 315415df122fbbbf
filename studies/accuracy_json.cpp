/// The JSON: everything that the tables show, and the single times behind their medians.
#include <nlohmann/json.hpp>

#include "pipeline/report/report.h"
#include "studies/accuracy_report.h"
#include "studies/statistics.h"

namespace quadrille::studies {
namespace {

using Json = nlohmann::ordered_json;

Json times_json(const std::vector<double>& sample) {
  const Spread s = spread_of(sample);
  return {{"median", s.median},
          {"lower_quartile", s.lower_quartile},
          {"upper_quartile", s.upper_quartile},
          {"least", s.least},
          {"most", s.most},
          {"runs", sample}};
}

Json image_json(const ImageError& e) {
  return {{"pixels", e.pixels},
          {"rmse", e.rmse},
          {"psnr_db", e.psnr_db},
          {"within_1_percent", e.within_1_percent},
          {"within_2_percent", e.within_2_percent},
          {"max", e.max}};
}

Json error_json(const CostError& e) {
  return {{"cycles_percent", e.cycles_percent},
          {"busy_mean_points", e.busy_mean_points},
          {"busy_max_points", e.busy_max_points},
          {"worst_unit", e.worst_unit.empty() ? Json(nullptr) : Json(e.worst_unit)},
          {"memory_percent", e.memory_percent},
          {"client_max_percent", e.client_max_percent},
          {"worst_client", e.worst_client.empty() ? Json(nullptr) : Json(e.worst_client)}};
}

Json cost_json(const MachineCost& cost) {
  Json busy = Json::object(), clients = Json::object();
  for (const UnitBusy& u : cost.units) busy[u.path] = u.percent;
  for (const ClientBytes& c : cost.clients) clients[c.name] = c.bytes;
  return {{"cycles", cost.cycles},
          {"memory_bytes", cost.memory_bytes},
          {"client_bytes", clients},
          {"busy_percent", busy}};
}

Json setting_json(const SettingResult& s) {
  return {{"setting", s.setting.name()},
          {"window_cycles", s.setting.window ? Json(*s.setting.window) : Json(nullptr)},
          {"approximate", s.setting.window.value_or(0) > 0},
          {"cpu_s", times_json(s.cpu_s)},
          {"wall_s", times_json(s.wall_s)},
          {"speed_up", s.speed_up},
          {"figures", s.cost ? cost_json(*s.cost) : Json(nullptr)},
          {"error", s.error ? error_json(*s.error) : Json(nullptr)},
          {"image", s.image},
          {"image_equals_exact", s.image == 0}};
}

Json precision_json(const PrecisionResult& p) {
  return {
      {"parameter", "gpu." + p.parameter},
      {"bits", p.bits},
      {"all_pixels", image_json(p.all)},
      {"same_triangle", p.same_triangle ? image_json(*p.same_triangle) : Json(nullptr)},
      {"other_triangle_percent", p.other_triangle_percent ? Json(*p.other_triangle_percent) : Json(nullptr)},
      {"cpu_s", times_json(p.cpu_s)}};
}

Json scene_json(const SceneAccuracy& scene) {
  Json settings = Json::array(), images = Json::array(), precision = Json::array();
  for (const SettingResult& s : scene.settings) settings.push_back(setting_json(s));
  for (const ImageError& e : scene.images) images.push_back(image_json(e));
  for (const PrecisionResult& p : scene.precision) precision.push_back(precision_json(p));
  return {{"scene", scene.name},  {"width", scene.width}, {"height", scene.height},
          {"settings", settings}, {"images", images},     {"precision", precision}};
}

}  // namespace

std::string accuracy_json(std::span<const SceneAccuracy> scenes, const pipeline::MachineConfig& machine) {
  Json all = Json::array();
  for (const SceneAccuracy& scene : scenes) all.push_back(scene_json(scene));
  const Json document = {{"schema", kAccuracySchema},
                         {"machine", Json::parse(pipeline::machine_json(machine))},
                         {"scenes", all}};
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadrille::studies
