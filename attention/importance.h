// How much each non-diffuse object matters: bottom-up saliency over its mask, top-down task importance, and
// the order made of them (Haber et al. 2001, section 3).
#pragma once

#include <cstdint>
#include <vector>

#include "attention/saliency.h"
#include "core/corrective/messages.h"
#include "core/image.h"

namespace saccade::attention {

/// --order. All but `attention` are baselines to measure it against.
enum class Order {
  attention,   ///< importance, (1 - a) saliency + a task, times what samples are worth there (usesGains)
  importance,  ///< the paper's: importance alone
  gain,        ///< what samples are worth alone
  task,        ///< task importance alone
  random,      ///< hash of id and seed
  scanline,    ///< the higher the top of the object's box, the earlier; then the further left
  largest,     ///< pixels on the mask
};

struct AttentionOptions {
  Order order = Order::attention;
  float attention = 0.5f;  ///< --attention a: 0 saliency .. 1 task
  SaliencyOptions saliency{};
  std::uint32_t seed = 1;  ///< for Order::random
};

/// By id, as many entries as the frame has extents; 0 for [0] and for what the frame does not show.
struct Importance {
  std::vector<float> saliency;  ///< [0, 1]; empty when the order does not ask for saliency
  std::vector<float> task;      ///< (0, 1] where visible
  std::vector<float> attended;  ///< [0, 1], what clicks add; empty when nothing is attended to
  std::vector<float> priority;  ///< where visible: (0, 1] by the order, plus `attended`
};

/// Mean saliency over each object's mask; the map has the frame's size, else core::Error. The mean, not a
/// quantile: a sample goes anywhere on the mask, so ordering by the mean puts most saliency right per sample
/// traced, and a large object with one salient corner does not overtake a small one that is salient as a
/// whole. One pass. Any thread.
std::vector<float> objectSaliency(const core::FrameSnapshot& frame, const core::ImageGray& saliency);

/// (p + sqrt(k)) / 2 with p = 1 - distance of the box's centre from the image's over half the diagonal and k
/// = the share of the image's pixels on the mask. The paper leaves open how the two factors combine: the mean
/// keeps a small object in the middle and a large one at the border both in the running; the root makes of
/// the share of the area one of the side, comparable to a distance (a share of 4 % would hardly count beside
/// p). Any thread.
std::vector<float> taskImportance(const core::FrameSnapshot& frame);

/// All of it. `saliency` may be empty for orders other than `attention` (see needsSaliency); `attended`
/// (attention/attended.h) is empty or has an entry for each of the frame's extents. Any thread.
Importance importanceOf(const core::FrameSnapshot& frame, const core::ImageGray& saliency,
                        const AttentionOptions& options, std::vector<float> attended = {});

inline bool needsSaliency(Order order) { return order == Order::attention || order == Order::importance; }
/// Whether the queue multiplies the priority by core::SampleGains: those of the samples that have arrived, of
/// which the analyzer knows nothing.
inline bool usesGains(Order order) { return order == Order::attention || order == Order::gain; }

}  // namespace saccade::attention
