/// A FIFO of the vertices shaded last, any of which a later batch's triangle may name: the post-transform
/// cache of older machines.
#include "models/geometry/post_transform.h"

#include <deque>
#include <unordered_map>
#include <vector>

namespace quadrille::models {

namespace {

// The corners at hand may push each other out, so a triangle asks for three lanes.
class FifoReuse final : public VertexReuse {
 public:
  explicit FifoReuse(const VertexReuseSetup& setup)
      : VertexReuse(setup), entries_(static_cast<std::size_t>(setup.entries)) {
    QUADRILLE_CHECK(setup.entries >= 3, "a FIFO of {} vertices", setup.entries);
  }
  void start_draw() override {
    order_.clear();
    places_.clear();
    remembered_.clear();
    slots_remembered_ = 0;
  }
  VertexPlace place(std::uint32_t vertex) override {
    if (const auto known = places_.find(vertex); known != places_.end()) return known->second;
    const VertexPlace place{slot(), add_lane(vertex)};
    remember(vertex, place);
    return place;
  }
  [[nodiscard]] bool remembers(std::uint32_t slot) const override {
    return slot < remembered_.size() && remembered_[slot] > 0;
  }
  [[nodiscard]] int slots_remembered() const override { return slots_remembered_; }
  void limit_slots(int slots) override {
    while (slots_remembered_ > slots) forget_oldest();
  }

 private:
  void remember(std::uint32_t vertex, const VertexPlace& place) {
    if (order_.size() == entries_) forget_oldest();
    order_.push_back(vertex);
    places_.emplace(vertex, place);
    if (place.slot >= remembered_.size()) remembered_.resize(place.slot + 1);
    if (remembered_[place.slot]++ == 0) ++slots_remembered_;
  }
  void forget_oldest() {
    const auto oldest = places_.find(order_.front());
    if (--remembered_[oldest->second.slot] == 0) --slots_remembered_;
    places_.erase(oldest);
    order_.pop_front();
  }

  std::size_t entries_;
  std::deque<std::uint32_t> order_;  ///< vertices remembered, the oldest first
  std::unordered_map<std::uint32_t, VertexPlace> places_;
  std::vector<int> remembered_;  ///< vertices, by slot
  int slots_remembered_ = 0;
};

}  // namespace

constinit const VertexReusePolicy kFifoReuse{
    "fifo", "the vertices shaded last, in any batch: fewer are shaded, and batches depend on each other",
    [](const VertexReuseSetup& setup) -> std::unique_ptr<VertexReuse> {
      return std::make_unique<FifoReuse>(setup);
    }};

}  // namespace quadrille::models
