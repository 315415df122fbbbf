/// When the attachments of a stream hold something, level by level and layer by layer, and whether anyone
/// reads it later: what a pass must leave in memory, and what a shader may sample.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::pipeline {

class AttachmentLives {
 public:
  /// Of a validated stream.
  explicit AttachmentLives(const traces::CommandStream& stream);
  /// May what pass `pass` leaves there be read by a later one: by loading it, or by sampling it through any
  /// descriptor set that is bound then?
  [[nodiscard]] bool read_after(const traces::ImagePart& part, std::size_t pass) const;
  /// Throws `UserError` unless a draw of pass `pass` may sample what is bound: a texture, or levels of an
  /// attachment that earlier passes have stored and this one does not draw to. `program` is named.
  void check_sampled(const traces::TextureDescriptor& bound, std::size_t pass,
                     const std::string& program) const;

 private:
  struct Use {
    std::size_t pass = 0;
    bool attached = false, loads = false, stores = false;  ///< as an attachment; else: may be sampled
  };
  void check_sampled(const traces::ImagePart& part, std::size_t pass, const std::string& program) const;
  void note_sampled(const traces::TextureDescriptor& bound, std::size_t pass);

  const traces::CommandStream& stream_;
  std::map<traces::ImagePart, std::vector<Use>> uses_;  ///< in order
};

}  // namespace quadrille::pipeline
