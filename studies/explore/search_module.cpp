/// The module's search: pagmo's NSGA-II over models of the objectives that OpenTURNS fits to what was drawn.
///
/// A frame takes seconds, a guess microseconds. So each round fits a Gaussian process to the logarithm of an
/// objective, lets NSGA-II find the front of the guesses, and asks for the machines of that front which lie
/// farthest apart. What is known without a frame, such as a cost by formula, is not guessed.
#include "studies/explore/design_module.h"

#include <openturns/OT.hxx>
#include <openturns/TBB.hxx>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/utils/hypervolume.hpp>
#include <pagmo/utils/multi_objective.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include "studies/explore/guarded_call.h"

namespace {

using Row = std::vector<double>;

constexpr unsigned kPopulation = 64, kGenerations = 60;
constexpr double kCrossover = 0.9, kMutation = 0.15;
constexpr double kIllegal = 1e6;  // far above any guess, which are logarithms or parts of a spread

/// A guess of one objective, from places to the scale on which it is compared.
class Model {
 public:
  Model(const OT::Sample& places, const Row& values) {
    logarithmic_ = std::all_of(values.begin(), values.end(), [](double v) { return v > 0; });
    OT::Sample scaled(places.getSize(), 1);
    for (std::size_t i = 0; i < values.size(); ++i) scaled(i, 0) = unscaled(values[i]);
    mean_ = scaled.computeMean()[0];
    spread_ = scaled.computeStandardDeviation()[0];
    if (!(spread_ > 1e-12)) return;  // it is the same everywhere
    for (std::size_t i = 0; i < values.size(); ++i) scaled(i, 0) = (scaled(i, 0) - mean_) / spread_;
    const std::size_t width = places.getDimension();
    OT::KrigingAlgorithm algorithm(places, scaled,
                                   OT::MaternModel(OT::Point(width, 0.5), OT::Point(1, 1), 2.5),
                                   OT::LinearBasisFactory(width).build());
    algorithm.setOptimizationBounds(OT::Interval(OT::Point(width, 0.05), OT::Point(width, 8)));
    algorithm.run();
    guess_ = std::make_unique<OT::Function>(algorithm.getResult().getMetaModel());
  }
  /// The scale of comparison, of a value that is known.
  [[nodiscard]] double scaled(double value) const {
    return spread_ > 1e-12 ? (unscaled(value) - mean_) / spread_ : 0;
  }
  [[nodiscard]] double guess(const OT::Point& place) const { return guess_ ? (*guess_)(place)[0] : 0; }

 private:
  [[nodiscard]] double unscaled(double value) const {
    return logarithmic_ ? std::log(std::max(value, std::numeric_limits<double>::min())) : value;
  }
  bool logarithmic_ = false;
  double mean_ = 0, spread_ = 0;
  std::unique_ptr<OT::Function> guess_;
};

/// What a round knows, and the machines that it has looked at.
struct Round {
  const QuadrilleSearch& asked;
  std::vector<Model> models;
  std::map<Row, Row> looked_at{};

  /// Places of pagmo's variables: those of whole numbers come last.
  [[nodiscard]] Row place_of(const Row& variables) const {
    Row place(asked.dimensions);
    std::size_t at = 0;
    for (const bool whole : {false, true})
      for (std::size_t i = 0; i < asked.dimensions; ++i)
        if ((asked.levels[i] > 0) == whole) {
          place[i] = whole ? (variables[at] + 0.5) / static_cast<double>(asked.levels[i]) : variables[at];
          ++at;
        }
    return place;
  }
  [[nodiscard]] const Row& objectives(const Row& place) {
    const auto [entry, fresh] = looked_at.try_emplace(place);
    if (!fresh) return entry->second;
    Row exact(asked.objectives, std::numeric_limits<double>::quiet_NaN());
    Row values(asked.objectives, kIllegal);
    if (asked.judge(asked.owner, place.data(), exact.data())) {
      OT::Point point(asked.dimensions);
      std::copy(place.begin(), place.end(), point.begin());
      for (std::size_t i = 0; i < asked.objectives; ++i)
        values[i] = std::isnan(exact[i]) ? models[i].guess(point) : models[i].scaled(exact[i]);
      values = within_limits(std::move(values));
    }
    return entry->second = values;
  }
  /// What is beyond a limit comes after all that is not, the nearest first.
  [[nodiscard]] Row within_limits(Row values) const {
    double beyond = 0;
    for (std::size_t i = 0; i < asked.objectives; ++i)
      if (std::isfinite(asked.most[i])) beyond += std::max(0.0, values[i] - models[i].scaled(asked.most[i]));
    if (beyond > 0)
      for (double& value : values) value += 100 * (1 + beyond);
    return values;
  }
};

/// The problem as pagmo has it.
struct Guesses {
  std::shared_ptr<Round> round;
  [[nodiscard]] pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    return round->objectives(round->place_of(x));
  }
  [[nodiscard]] pagmo::vector_double::size_type get_nobj() const { return round->asked.objectives; }
  [[nodiscard]] pagmo::vector_double::size_type get_nix() const {
    return static_cast<std::size_t>(std::count_if(round->asked.levels,
                                                  round->asked.levels + round->asked.dimensions,
                                                  [](std::size_t levels) { return levels > 0; }));
  }
  [[nodiscard]] std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    pagmo::vector_double low(round->asked.dimensions, 0), high;
    for (std::size_t i = 0; i < round->asked.dimensions; ++i)
      if (round->asked.levels[i] == 0) high.push_back(1);
    for (std::size_t i = 0; i < round->asked.dimensions; ++i)
      if (round->asked.levels[i] > 0) high.push_back(static_cast<double>(round->asked.levels[i] - 1));
    return {low, high};
  }
};

std::vector<std::size_t> front_of(const std::vector<Row>& values) {
  if (values.size() < 2) return values.empty() ? std::vector<std::size_t>{} : std::vector<std::size_t>{0};
  const auto fronts = std::get<0>(pagmo::fast_non_dominated_sorting(values));
  return {fronts[0].begin(), fronts[0].end()};
}

double distance(const Row& a, const Row& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

/// The rows of the guessed front that are not drawn yet, those farthest from what was drawn and chosen first.
std::vector<Row> chosen(Round& round, const std::vector<Row>& drawn_places, std::vector<Row> drawn_values,
                        std::size_t wanted) {
  std::vector<Row> places, values;
  for (const auto& [place, value] : round.looked_at) {
    if (value[0] >= kIllegal ||
        std::find(drawn_places.begin(), drawn_places.end(), place) != drawn_places.end())
      continue;
    places.push_back(place);
    values.push_back(value);
  }
  // What was drawn and is on the front keeps guesses that it dominates off it.
  std::vector<Row> all = values;
  all.insert(all.end(), drawn_values.begin(), drawn_values.end());
  std::vector<std::size_t> front = front_of(all);
  std::erase_if(front, [&](std::size_t i) { return i >= values.size(); });
  std::vector<Row> out;
  while (out.size() < wanted && !front.empty()) {
    const auto apart = [&](std::size_t i) {
      double nearest = std::numeric_limits<double>::max();
      for (const Row& value : drawn_values) nearest = std::min(nearest, distance(values[i], value));
      return nearest;
    };
    const auto best = std::max_element(front.begin(), front.end(),
                                       [&](std::size_t a, std::size_t b) { return apart(a) < apart(b); });
    out.push_back(places[*best]);
    drawn_values.push_back(values[*best]);
    front.erase(best);
  }
  return out;
}

/// The models of the objectives, from what was drawn.
void fit(Round& round, const std::vector<Row>& drawn) {
  const QuadrilleSearch& asked = round.asked;
  OT::Sample known(asked.known, asked.dimensions);
  for (std::size_t row = 0; row < asked.known; ++row)
    for (std::size_t i = 0; i < asked.dimensions; ++i) known(row, i) = drawn[row][i];
  round.models.reserve(asked.objectives);
  for (std::size_t i = 0; i < asked.objectives; ++i) {
    Row values(asked.known);
    for (std::size_t row = 0; row < asked.known; ++row)
      values[row] = asked.values[row * asked.objectives + i];
    round.models.emplace_back(known, values);
  }
}

/// What was drawn came to, on the scales of the models.
std::vector<Row> scaled_values(const Round& round) {
  const QuadrilleSearch& asked = round.asked;
  std::vector<Row> all(asked.known, Row(asked.objectives));
  for (std::size_t row = 0; row < asked.known; ++row) {
    for (std::size_t i = 0; i < asked.objectives; ++i)
      all[row][i] = round.models[i].scaled(asked.values[row * asked.objectives + i]);
    all[row] = round.within_limits(std::move(all[row]));
  }
  return all;
}

std::vector<Row> next_places(const QuadrilleSearch& asked) {
  const auto round = std::make_shared<Round>(Round{asked, {}});
  std::vector<Row> drawn(asked.known);
  for (std::size_t row = 0; row < asked.known; ++row)
    drawn[row] = Row(asked.places + row * asked.dimensions, asked.places + (row + 1) * asked.dimensions);
  fit(*round, drawn);
  const pagmo::population population{pagmo::problem{Guesses{round}}, kPopulation,
                                     static_cast<unsigned>(asked.seed)};
  const pagmo::algorithm nsga2{
      pagmo::nsga2(kGenerations, kCrossover, 10, kMutation, 20, static_cast<unsigned>(asked.seed + 1))};
  (void)nsga2.evolve(population);  // every machine that it looked at is in `looked_at`
  return chosen(*round, drawn, scaled_values(*round), asked.wanted);
}

}  // namespace

extern "C" {

[[gnu::visibility("default")]] bool quadrille_search(const QuadrilleSearch* asked, double* out,
                                                     std::size_t* found, QuadrilleMessage* message) {
  return quadrille::guarded_call(message, [&] {
    OT::Log::Show(OT::Log::NONE);
    OT::TBB::Disable();  // sums in one order, so that the same seed gives the same machines on any host
    // Machines that lie close together would make the matrix of a model singular.
    OT::ResourceMap::SetAsScalar("CovarianceModel-DefaultNuggetFactor", 1e-8);
    OT::RandomGenerator::SetSeed(asked->seed);
    const std::vector<Row> places = next_places(*asked);
    *found = places.size();
    for (std::size_t row = 0; row < places.size(); ++row)
      std::copy(places[row].begin(), places[row].end(), out + row * asked->dimensions);
  });
}

[[gnu::visibility("default")]] bool quadrille_front(std::size_t rows, std::size_t objectives,
                                                    const double* values, std::uint8_t* on_front,
                                                    QuadrilleMessage* message) {
  return quadrille::guarded_call(message, [&] {
    // The sort keeps a list of every pair, so long tables are sorted in parts, and then the fronts of these.
    constexpr std::size_t kMostRows = 2000;
    std::vector<Row> kept;
    std::vector<std::size_t> numbers;
    for (std::size_t begin = 0; begin < rows; begin += kMostRows) {
      std::vector<Row> part;
      for (std::size_t row = begin; row < std::min(rows, begin + kMostRows); ++row)
        part.emplace_back(values + row * objectives, values + (row + 1) * objectives);
      for (const std::size_t i : front_of(part)) {
        kept.push_back(part[i]);
        numbers.push_back(begin + i);
      }
    }
    std::fill(on_front, on_front + rows, std::uint8_t{0});
    for (const std::size_t i : front_of(kept)) on_front[numbers[i]] = 1;
  });
}

[[gnu::visibility("default")]] bool quadrille_hypervolume(std::size_t rows, std::size_t objectives,
                                                          const double* values, const double* reference,
                                                          double* out, QuadrilleMessage* message) {
  return quadrille::guarded_call(message, [&] {
    std::vector<Row> points;
    for (std::size_t row = 0; row < rows; ++row)
      points.emplace_back(values + row * objectives, values + (row + 1) * objectives);
    *out = pagmo::hypervolume(points, true).compute({reference, reference + objectives});
  });
}
}
