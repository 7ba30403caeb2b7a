#include "bench/reference/grade.h"

#include "attention/spectral_residual.h"
#include "core/image_io.h"
#include "core/metrics/flip.h"

namespace saccade::bench {

Grader::Grader(core::ImageRgb reference)
    : reference_(std::move(reference)),
      saliency_(attention::spectralResidual(core::toDisplay(reference_, 0))) {}

Grade Grader::grade(const core::ImageRgb& linear) const {
  Grade grade;
  grade.errors = core::compareLinear(reference_, linear);
  grade.flipSalient = flipSalient(grade.errors);
  return grade;
}

double Grader::flipSalient(const core::Comparison& errors) const {
  return core::weightedMeanOf(errors.flipMap, saliency_);
}

void addErrors(Record& record, const std::vector<Grade>& repeats) {
  const auto over = [&](auto figure) {
    std::vector<double> values;
    for (const Grade& grade : repeats) values.push_back(figure(grade));
    return Value::errors(values);
  };
  const auto add = [&](const char* name, double core::Comparison::*figure) {
    record.values[name] = over([figure](const Grade& g) { return g.errors.*figure; });
  };
  add("relmse", &core::Comparison::relmse);
  add("rmse", &core::Comparison::rmse);
  add("psnr", &core::Comparison::psnr);
  add("ssim", &core::Comparison::ssim);
  add("flip", &core::Comparison::flip);
  add("flip_median", &core::Comparison::flipMedian);
  add("flip_p95", &core::Comparison::flipP95);
  add("max_abs", &core::Comparison::maxAbs);
  record.values["flip_salient"] = over([](const Grade& g) { return g.flipSalient; });
  record.values["psnr"].unit = "dB";
  record.values["psnr"].better = record.values["ssim"].better = Better::higher;
}

}  // namespace saccade::bench
