/// When the attachments of a stream hold something, and whether anyone reads it later: what a pass must leave
/// in memory, and what a shader may sample.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::pipeline {

class AttachmentLives {
 public:
  /// Of a validated stream.
  explicit AttachmentLives(const traces::CommandStream& stream);
  /// May what pass `pass` leaves in the image be read by a later one: by loading it, or by sampling it
  /// through any descriptor set that is bound then?
  [[nodiscard]] bool read_after(traces::Index image, std::size_t pass) const;
  /// Throws `UserError` unless a draw of pass `pass` may sample the image: it is a texture, or an attachment
  /// of another pass that an earlier one has stored. `program` is named.
  void check_sampled(traces::Index image, std::size_t pass, const std::string& program) const;

 private:
  struct Use {
    std::size_t pass = 0;
    bool attached = false, loads = false, stores = false;  ///< as an attachment; else: may be sampled
  };
  const traces::CommandStream& stream_;
  std::vector<std::vector<Use>> uses_;  ///< by image, in order
};

}  // namespace quadrille::pipeline
