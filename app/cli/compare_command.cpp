// saccade compare: how far one picture is from another.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/metrics/colormap.h"
#include "core/metrics/comparison.h"

namespace saccade::app {

namespace {

struct CompareOptions {
  std::string reference, test, map;
  bool json = false;
};

bool isExr(const std::string& file) { return std::filesystem::path(file).extension() == ".exr"; }

core::Comparison comparePictures(const CompareOptions& o) {
  if (isExr(o.reference) != isExr(o.test)) {
    throw core::UsageError(
        "compare needs two EXR files (compared linear) or two PNG files (as sRGB values), not one of each");
  }
  return isExr(o.reference) ? core::compareLinear(core::readExr(o.reference), core::readExr(o.test))
                            : core::compareDisplay(core::readImage8(o.reference), core::readImage8(o.test));
}

/// JSON knows no infinity: the PSNR of equal images is null.
nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

void printJson(const core::Comparison& c) {
  const nlohmann::ordered_json json = {{"rmse", number(c.rmse)},        {"relmse", number(c.relmse)},
                                       {"psnr", number(c.psnr)},        {"ssim", number(c.ssim)},
                                       {"flip", number(c.flip)},        {"flip_median", number(c.flipMedian)},
                                       {"flip_p95", number(c.flipP95)}, {"max_abs", number(c.maxAbs)}};
  std::printf("%s\n", json.dump(2).c_str());
}

void print(const core::Comparison& c) {
  std::printf("RMSE %.6g, relative MSE %.6g, PSNR %.2f dB, SSIM %.5f, largest difference %.6g\n", c.rmse,
              c.relmse, c.psnr, c.ssim, c.maxAbs);
  std::printf("FLIP mean %.5f, weighted median %.5f, 95th percentile %.5f\n", c.flip, c.flipMedian,
              c.flipP95);
}

int compare(const CompareOptions& o) {
  const core::Comparison c = comparePictures(o);
  if (!o.map.empty()) core::writePng(o.map, core::rampPicture(c.flipMap));
  if (o.json) {
    printJson(c);
  } else {
    print(c);
  }
  return 0;
}

}  // namespace

void addCompareCommand(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand(
      "compare", "Compare a picture with its reference: RMSE, relative MSE, PSNR, SSIM, FLIP");
  auto o = std::make_shared<CompareOptions>();
  command
      ->add_option("REFERENCE", o->reference,
                   "EXR (compared linear; FLIP after the display transform) or PNG (sRGB values)")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("TEST", o->test, "Picture of the same size and kind")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_flag("--json", o->json, "Machine-readable output");
  command->add_option("--map", o->map, "Write the FLIP error map to this PNG");
  command->callback([o, &run] { run = [o] { return compare(*o); }; });
}

}  // namespace saccade::app
