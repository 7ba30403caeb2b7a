// Where a frame loop reports all that its pictures depend on, in the order in which it happened.
#pragma once

#include <memory>

#include "app/session/corrected_picture.h"
#include "core/corrective/messages.h"
#include "core/image.h"

namespace saccade::app {

/// A finished frame. The batches reported since the last one were taken for it, in that order.
struct ShownFrame {
  core::FramePtr frame;             ///< camera, size and epoch
  bool newView = true;              ///< the frame began anew: CorrectedPicture::begin ran
  const PictureSettings& settings;  ///< valid during the call
  float attention = 0;              ///< weight of task importance: of the schedule, not of the picture
  std::shared_ptr<const core::ImageRgba8> display;  ///< as shown
};

/// Called on the main thread, between the steps of a frame: hands over and returns.
class SessionSink {
 public:
  virtual ~SessionSink() = default;
  virtual void batch(core::SampleBatch&& batch) = 0;
  virtual void frame(const ShownFrame& frame) = 0;
};

}  // namespace saccade::app
