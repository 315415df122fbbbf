#include "hw/command/command_processor.h"

#include "hw/frame/laws.h"

#include <algorithm>

namespace quadrille::hw {

CommandProcessor::CommandProcessor(sc_core::sc_module_name name, const UnitContext& context,
                                   const Params& params, QuietLog& quiet)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      quiet_log_(quiet),
      retired_by_(static_cast<std::size_t>(context.machine.partitions)) {
  add_initiation_rate("draw_clk");
  add_places("draws_in_flight", [this] { return step_ == Step::kDraw && all_in_flight(); });
  for (int i = 0; i < context.machine.partitions; ++i) {
    retire_in.add(*this, fmt::format("retire_in_{}", i).c_str(), LinkRole::kReply);
  }
  for (int f = 0; f < context.machine.front_ends; ++f) {
    const std::string port = context.front_end_port("draw_out", f);
    draw_out.push_back(std::make_unique<FifoOut<DrawToken>>(*this, port.c_str()));
  }
  retired_at_.resize(frame_.draws.size());
  if (frame_.passes.empty()) step_ = Step::kDone;
}

std::string CommandProcessor::state_text() const {
  return fmt::format("pass {} of {}, {} draws issued, {} retired", pass_, frame_.passes.size(), draw_,
                     retired_);
}

Wake CommandProcessor::retire_wake() const { return retire_in.earliest(); }

Wake CommandProcessor::draw_wake() const {
  Wake wake(free_);
  for (const auto& out : draw_out) wake.output(*out);
  return wake;
}

void CommandProcessor::send(Tick now, const DrawToken& token) {
  for (const auto& out : draw_out) out->push(now, token);
}

Wake CommandProcessor::issue_wake() const {
  switch (step_) {
    case Step::kDraw:
      if (culls()) return Wake(free_);
      if (all_in_flight()) return Wake::never(retire_in[0]);
      return draw_wake();
    case Step::kPassBegin:
    case Step::kDrawEnd:
    case Step::kPassEnd: return draw_wake();
    case Step::kWaitFlush: return Wake::never(retire_in[0]);
    case Step::kScan: return Wake(free_).output(scan_out);
    case Step::kWaitScan: return Wake().input(scan_done_in);
    case Step::kDone: return Wake::never(scan_done_in);
  }
  return Wake(kNever);
}

Wake CommandProcessor::next() const { return Wake::sooner(retire_wake(), issue_wake()); }

void CommandProcessor::act(Tick now) {
  if (retire_wake().at() <= now) take_retirements(now);
  if (issue_wake().at() <= now) issue(now);
}

void CommandProcessor::take_retirements(Tick now) {
  retire_in.take_ready(now, [&](std::size_t partition, const RetireToken& token) {
    if (token.kind == TokenKind::kPassEnd) ++flushes_;
    else ++retired_by_[partition];
  });
  const std::uint32_t all = *std::min_element(retired_by_.begin(), retired_by_.end());
  stats_.draws_retired += all - retired_;
  for (; retired_ < all; ++retired_) retired_at_[sent_[retired_]] = now;
  if (step_ == Step::kWaitFlush && flushes_ == static_cast<int>(retire_in.size())) {
    flushes_ = 0;
    render_end_ = now;
    quiet_since_ = now;
    step_ = pass_ + 1 == frame_.passes.size() ? Step::kScan : Step::kPassBegin;
    if (step_ == Step::kPassBegin) ++pass_;
  }
}

void CommandProcessor::issue(Tick now) {
  const PassState& pass = frame_.passes[std::min<std::size_t>(pass_, frame_.passes.size() - 1)];
  stats_.working_for(step_ == Step::kDraw || step_ == Step::kDrawEnd ? DrawId(draw_) : kNoDraw);
  switch (step_) {
    case Step::kPassBegin:
      quiet_log_.add(quiet_since_, now);
      send(now, {TokenKind::kPassBegin, PassId(pass_)});
      ++stats_.passes;
      step_ = pass.draws > 0 ? Step::kDraw : Step::kPassEnd;
      break;
    case Step::kDraw:
      if (culls()) {
        cull(now);
        next_draw(pass);
        return;
      }
      send(now, {TokenKind::kWork, DrawId(draw_)});
      ++stats_.draws;
      sent_.push_back(draw_);
      issued_at_.push_back(now);
      free_ = after(now, params_.draw_clk);
      occupy(now, params_.draw_clk);
      step_ = Step::kDrawEnd;
      return;
    case Step::kDrawEnd:
      send(now, {TokenKind::kDrawEnd, DrawId(draw_)});
      next_draw(pass);
      break;
    case Step::kPassEnd:
      send(now, {TokenKind::kPassEnd, PassId(pass_)});
      step_ = Step::kWaitFlush;
      break;
    case Step::kScan:
      scan_out.push(now, {PassId(pass_)});
      step_ = Step::kWaitScan;
      break;
    case Step::kWaitScan:
      (void)scan_done_in.pop(now);
      end_ = now;
      step_ = Step::kDone;
      return;
    case Step::kWaitFlush:
    case Step::kDone: return;
  }
  free_ = after(now, 1);
  occupy(now, 1);
}

void CommandProcessor::cull(Tick now) {
  ++stats_.draws_culled;
  issued_at_.push_back(now);
  free_ = after(now, params_.draw_clk);
  retired_at_[draw_] = free_;
  occupy(now, params_.draw_clk);
}

void CommandProcessor::next_draw(const PassState& pass) {
  ++draw_;
  step_ = draw_ == pass.first_draw.index() + pass.draws ? Step::kPassEnd : Step::kDraw;
}

void CommandProcessor::audit(Audit& audit) const {
  audit.left(laws::kDrawsOfFrame, stats_.draws.value() + stats_.draws_culled.value());
  audit.left(laws::kDraws, stats_.draws.value() * retire_in.size());
}

std::vector<Facet> CommandProcessor::row() const {
  std::vector<Facet> facets{count("draws", stats_.draws), count("passes", stats_.passes)};
  if (params_.cull_draws) facets.push_back(count("culled", stats_.draws_culled));
  return facets;
}

}  // namespace quadrille::hw
