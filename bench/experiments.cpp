// The list of experiments: one line each, in the order in which they run.
#include "bench/approximation/approximation.h"
#include "bench/attention/attention.h"
#include "bench/cache/cache.h"
#include "bench/growth/growth.h"
#include "bench/hard/hard.h"
#include "bench/harness/experiment.h"
#include "bench/load/first_frame.h"
#include "bench/load/load.h"
#include "bench/many_lights/many_lights.h"
#include "bench/maps/maps.h"
#include "bench/moving/moving.h"
#include "bench/overlays/overlays.h"
#include "bench/paper/figure5.h"
#include "bench/paper/figure6.h"
#include "bench/paper/gallery_walk.h"
#include "bench/paper/section5.h"
#include "bench/paper/untraced.h"
#include "bench/peers/peers.h"
#include "bench/quality/quality.h"
#include "bench/rays/rays.h"
#include "bench/recording/recording.h"
#include "bench/still/still.h"
#include "bench/validity/validity.h"
#include "bench/walkorder/walk_order.h"

namespace saccade::bench {

const std::vector<Experiment>& allExperiments() {
  static const std::vector<Experiment> experiments{
      {"reference",
       "How good are the references of the still views themselves?",
       {Suite::quick, Suite::paper},
       &runReferences},
      {"still",
       "A still view: error against seconds of every method",
       {Suite::quick, Suite::paper},
       &runStill},
      {"order",
       "Which order of samples nears the converged picture with the fewest?",
       {Suite::quick, Suite::paper},
       &runOrder},
      {"walk-order",
       "Does it pay to correct first what attracts the eye, at 1, 5 and 20 thousand samples a frame?",
       {Suite::paper},
       &measureWalkOrder},
      {"rays",
       "How much of bare Embree's speed is left in the corrective loop?",
       {Suite::quick},
       &measureRays},
      {"attention",
       "What does the saliency model cost, beside plain OpenCV, and does it foretell where people look?",
       {},
       &measureAttention},
      {"load", "What takes the time from a file to its first frame?", {}, &measureLoad},
      {"first-frame",
       "How soon after its start does the window show a scene whose maps are ready?",
       {},
       &measureFirstFrame},
      {"many-lights",
       "What does a light sample among many lamps cost, and how far off is it?",
       {Suite::quick},
       &measureManyLights},
      {"maps",
       "How far are the illumination maps from the light that is there, and how soon, beside path tracing?",
       {Suite::quick, Suite::paper},
       &measureMaps},
      {"moving",
       "How good is the picture while the camera moves, at 8 to 125 ms a frame?",
       {Suite::quick, Suite::paper},
       &measureMoving},
      {"quality",
       "How far is the converged picture from the path-traced one, and what is the rest made of?",
       {},
       &measureQuality},
      {"peers",
       "How soon is which renderer as near to the truth: Blender's Cycles, our path tracer, our corrections?",
       {},
       &measurePeers},
      {"validity",
       "How valid are the cached samples that aging keeps, and how many valid ones does it drop?",
       {},
       &measureValidity},
      {"approximation",
       "How near is what light probes tell to the converged picture, until samples arrive?",
       {},
       &measureApproximation},
      {"overlays", "What does an overlay cost a frame in the window?", {}, &measureOverlays},
      {"growth",
       "How do frame time and memory grow with the scene, the cache, the picture and the tracers?",
       {},
       &measureGrowth},
      {"paper",
       "Haber 2001, section 5, row by row: ours beside the paper's",
       {Suite::paper},
       &measureSection5},
      {"figures",
       "Haber 2001, Figures 5 and 6: splats of the first levels, samples warped for reuse",
       {Suite::paper},
       [](Session& session) {
         drawFigure5(session);
         drawFigure6(session);
       }},
      {"gallery-walk",
       "Does the frame rate hold in the museum hall at 8 and 25 frames a second?",
       {Suite::paper},
       &measureGalleryWalk},
      {"recording",
       "What does recording a walk cost the frame, and how large does it get?",
       {Suite::paper},
       &measureRecording},
      {"untraced",
       "Is the frame without tracing at most half as long again as its bare draw?",
       {Suite::paper},
       &measureUntraced},
      {"cache",
       "Do aging and warping stay linear in the cached samples, up to a million?",
       {Suite::paper},
       &measureCache},
      {"hard", "How far off are the numerical hard cases?", {Suite::hard}, &measureHardCases},
  };
  return experiments;
}

}  // namespace saccade::bench
