/// What attachments may be: their samples, levels and layers. As in validate_test.cpp, each case damages one
/// thing in a valid stream.
#include "tests/traces/defects.h"

using namespace quadrille;
using namespace quadrille::traces;

TEST_CASE("validate: samples a pixel, and what they are resolved to") {
  const auto four = [](auto& s) { use_samples(s, 4); };
  CommandStream good = small_stream();
  four(good);
  validate(good);
  const auto begin = [](auto& s) -> BeginPass& { return command<BeginPass>(s, 0); };
  expect({
      {"3 samples a pixel; 1, 2, 4 and 8 are possible", [](auto& s) { s.images[1].samples = 3; }},
      {"image 0 'white': only an attachment has 4 samples", [](auto& s) { s.images[0].samples = 4; }},
      {"descriptor set 0 binding 1: a view '2d-ms' of image 0 'white' of 1 samples",
       [](auto& s) { s.descriptor_sets[0].textures[0].view = ViewKind::k2DMultisampled; }},
      {"depth attachment: image 2 of 1 samples a pixel beside one of 4",
       [](auto& s) {
         s.images[1].usage = kColorAttachment;
         s.images[1].samples = 4;
       }},
      {"resolve attachment: image 99 does not exist",
       [=](auto& s) {
         four(s);
         begin(s).colors[0].resolve = 99;
       }},
      {"several samples a pixel are resolved to a colour attachment of one",
       [=](auto& s) { begin(s).colors[0].resolve = 1; }},
      {"differ in size or format",
       [=](auto& s) {
         four(s);
         s.images[begin(s).colors[0].resolve].height += 1;
       }},
      {"resolves the samples of its first colours nowhere",
       [=](auto& s) {
         four(s);
         begin(s).colors[0].resolve = kNone;
       }},
  });
}

TEST_CASE("validate: levels and layers of attachments") {
  const auto add_levels = [](auto& s) {
    s.images[1].levels = s.images[2].levels = 7;
    s.images[1].layers = 2;
    BeginPass& pass = command<BeginPass>(s, 0);
    pass.colors[0].level = pass.depth.level = 1;
    pass.colors[0].layer = 1;
    command<SetViewport>(s, 1) = {0, 0, 32, 16};
    command<SetScissor>(s, 2) = {0, 0, 32, 16};
  };
  CommandStream good = small_stream();
  add_levels(good);
  validate(good);
  CHECK(shown_target(good).width == 32);
  CHECK(shown_target(good).height == 16);
  const auto colors = [](auto& s) -> ColorAttachmentUse& { return command<BeginPass>(s, 0).colors[0]; };
  expect({
      {"level 7 of layer 1 of image 1 'colour', which has 7 levels and 2 layers",
       [=](auto& s) {
         add_levels(s);
         colors(s).level = 7;
       }},
      {"level 1 of layer 2 of image 1 'colour'",
       [=](auto& s) {
         add_levels(s);
         colors(s).layer = 2;
       }},
      {"image 2 of 16x8 beside one of 32x16",
       [=](auto& s) {
         add_levels(s);
         command<BeginPass>(s, 0).depth.level = 2;
       }},
      {"outside the target of 32x16",
       [=](auto& s) {
         add_levels(s);
         command<SetScissor>(s, 2).width = 33;
       }},
      {"image 1 is loaded before a pass has stored it",  // that layer was not
       [=](auto& s) {
         add_levels(s);
         BeginPass again = command<BeginPass>(s, 0);
         again.colors[0].load = LoadOp::kLoad;
         again.colors[0].layer = 0;
         s.commands.emplace_back(again);
         s.commands.emplace_back(EndPass{});
       }},
      {"7 levels of 4 samples a pixel; it can have one",
       [=](auto& s) {
         add_levels(s);
         s.images[1].samples = 4;
       }},
  });
  // Two layers of an image in one pass are two attachments.
  auto& all = command<BeginPass>(good, 0).colors;
  all.push_back(all[0]);
  all[1].layer = 0;
  validate(good);
}
