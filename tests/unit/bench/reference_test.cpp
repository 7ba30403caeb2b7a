// References: what their keys depend on, how good they say they are, and that stopping, going on and broken
// files leave the picture as it is.
#include "bench/reference/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/reference/kept_sums.h"
#include "bench/reference/sums.h"
#include "core/image_io.h"
#include "tests/unit/core/own_cache_folder.h"

namespace saccade::bench {
namespace {

class References : public ::testing::Test {
 protected:
  static const app::Workspace& cornell() {
    static const auto workspace = [] {
      app::SceneOptions options;
      options.path = SACCADE_SOURCE_DIR "/data/scenes/cornell.glb";
      return app::openWithoutMaps(options);
    }();
    return *workspace;
  }
  static ReferenceView view(int width = 12, int height = 9) {
    ReferenceView v;
    v.camera = cornell().scene.cameras.at(0);
    v.size = {width, height};
    return v;
  }
  Reference compute(const ReferenceView& v, const Confidence& confidence, int threads = 2) {
    return computeReference(cornell(), v, confidence, threads, {}, warnings_);
  }
  std::filesystem::path fileOf(const ReferenceView& v) const {
    return referenceFile(referenceKey(cornell().scene, v));
  }
  static Confidence passable() { return {.relmse = 1e3, .capSeconds = 1e6}; }

  tests::OwnCacheFolder cache_;
  core::Warnings warnings_;
};

TEST_F(References, KeysDifferWithAllThatThePictureDependsOn) {
  const ReferenceView v = view();
  std::set<std::uint64_t> keys{referenceKey(cornell().scene, v)};
  EXPECT_EQ(referenceKey(cornell().scene, v), *keys.begin());
  const std::vector<std::function<void(ReferenceView&)>> changes{
      [](ReferenceView& c) { c.camera.eye.x = std::nextafter(c.camera.eye.x, 10.0f); },
      [](ReferenceView& c) { c.camera.at.y += 0.1f; },
      [](ReferenceView& c) {
        c.camera.up = {0.1f, 1, 0};
      },
      [](ReferenceView& c) { c.camera.fovYDegrees += 1; },
      [](ReferenceView& c) { c.size.width += 1; },
      [](ReferenceView& c) { std::swap(c.size.width, c.size.height); },
      [](ReferenceView& c) { c.transport = raytrace::Transport::diffuse; },
      [](ReferenceView& c) { c.diffuse = raytrace::DiffuseModel::burley; },
      [](ReferenceView& c) { c.bounces = 3; },
      [](ReferenceView& c) { c.seed = 2; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    ReferenceView changed = v;
    changes[i](changed);
    EXPECT_TRUE(keys.insert(referenceKey(cornell().scene, changed)).second) << "change " << i;
  }
  core::Scene painted = cornell().scene;
  painted.materials[0].baseColor.x *= 0.5f;
  EXPECT_TRUE(keys.insert(referenceKey(painted, v)).second);
  ReferenceView renamed = v;
  renamed.camera.name = "another name, the same picture";
  EXPECT_EQ(keys.count(referenceKey(cornell().scene, renamed)), 1u);
}

TEST_F(References, AreComputedOnceAndKept) {
  const Reference first = compute(view(), passable());
  EXPECT_TRUE(first.reached);
  EXPECT_EQ(first.samplesPerPixel, 64u) << "the least that is trusted";
  const Reference again = compute(view(), passable(), 0);
  EXPECT_EQ(again.radiance.pixels(), first.radiance.pixels());
  EXPECT_EQ(again.seconds, first.seconds) << "nothing was computed";
  EXPECT_EQ(again.own.flip, first.own.flip);
  EXPECT_TRUE(warnings_.empty());

  std::filesystem::path picture = fileOf(view()), text = picture;
  EXPECT_EQ(core::readExr(picture.replace_extension(".exr")).pixels(), first.radiance.pixels());
  const nlohmann::json about = nlohmann::json::parse(std::ifstream(text.replace_extension(".json")));
  EXPECT_EQ(about.at("samples_per_pixel"), 64);
  EXPECT_EQ(about.at("relmse"), first.own.relmse);
  EXPECT_EQ(cache_.folder().entries(), 1u) << "nothing but saccade/ in the cache";
}

TEST_F(References, GoOnWhereMoreConfidenceIsAsked) {
  const Reference rough = compute(view(), passable());
  const Confidence finer{.relmse = rough.own.relmse / 3, .capSeconds = 1e6};
  const Reference resumed = compute(view(), finer);
  EXPECT_LE(resumed.own.relmse, finer.relmse);
  EXPECT_GT(resumed.samplesPerPixel, rough.samplesPerPixel);
  std::filesystem::remove(fileOf(view()));
  const Reference straight = compute(view(), finer);
  EXPECT_EQ(straight.samplesPerPixel, resumed.samplesPerPixel);
  EXPECT_EQ(straight.radiance.pixels(), resumed.radiance.pixels());
}

TEST_F(References, AStoppedRunGoesOnToTheSamePicture) {
  const Confidence confidence{.relmse = compute(view(), passable()).own.relmse / 3, .capSeconds = 1e6};
  std::filesystem::remove(fileOf(view()));
  const Reference straight = compute(view(), confidence);
  std::filesystem::remove(fileOf(view()));

  std::uint64_t kept = 0;
  int stops = 0;
  // Stopped again and again, later each time; what is kept never shrinks.
  for (int reports = 5; reports <= 40; reports += 5) {
    std::stop_source source;
    int seen = 0;
    const core::Progress progress{[&](double) {
                                    if (++seen == reports) source.request_stop();
                                  },
                                  source.get_token()};
    try {
      computeReference(cornell(), view(), confidence, 1, progress, warnings_);
    } catch (const core::Error&) {
      ++stops;
      const ReferenceSums sums = readSums(fileOf(view()), straight.key, 12, 9);
      EXPECT_GE(sums.samplesPerHalf, kept);
      kept = sums.samplesPerHalf;
    }
  }
  EXPECT_GT(stops, 1);
  EXPECT_GT(kept, 0u);
  const Reference resumed = compute(view(), confidence);
  EXPECT_EQ(resumed.samplesPerPixel, straight.samplesPerPixel);
  EXPECT_EQ(resumed.radiance.pixels(), straight.radiance.pixels());
}

TEST_F(References, TimeUsedUpEndsTheWorkForGood) {
  const Confidence hopeless{.relmse = 0, .capSeconds = 1e-9};
  const Reference one = compute(view(), hopeless);
  EXPECT_FALSE(one.reached);
  EXPECT_EQ(one.samplesPerPixel, 16u) << "one pass";
  EXPECT_EQ(compute(view(), hopeless).samplesPerPixel, 16u);
}

TEST_F(References, BrokenFilesAreComputedAnewWithAWarning) {
  const Reference whole = compute(view(), passable());
  const std::filesystem::path file = fileOf(view());
  const auto size = std::filesystem::file_size(file);
  const std::vector<std::function<void()>> faults{
      [&] { std::filesystem::resize_file(file, size - 1); },
      [&] { std::filesystem::resize_file(file, size + 1); }, [&] { std::filesystem::resize_file(file, 0); },
      [&] { std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(100).put('\x55'); },
      // Another reference's file under this one's name.
      [&] {
        ReferenceView other = view();
        other.seed = 7;
        compute(other, passable());
        std::filesystem::copy_file(fileOf(other), file, std::filesystem::copy_options::overwrite_existing);
      }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    faults[i]();
    warnings_.clear();
    const Reference anew = compute(view(), passable());
    ASSERT_EQ(warnings_.size(), 1u) << "fault " << i;
    EXPECT_NE(warnings_[0].find("computing it anew"), std::string::npos) << warnings_[0];
    EXPECT_EQ(anew.radiance.pixels(), whole.radiance.pixels()) << "fault " << i;
    warnings_.clear();
    compute(view(), passable());
    EXPECT_TRUE(warnings_.empty()) << "fault " << i << " was mended";
  }
}

TEST_F(References, AnUnwritableCacheIsDoneWithout) {
  ::setenv("XDG_CACHE_HOME", "/proc", 1);
  const Reference r = compute(view(), passable());
  EXPECT_TRUE(r.reached);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("not kept"), std::string::npos) << warnings_[0];
}

TEST(ReferenceSums, HandComputed) {
  ReferenceSums sums(1, 1);
  sums.add(0, core::ImageRgb(1, 1, core::Vec3(1, 2, 0)), 8);
  sums.add(1, core::ImageRgb(1, 1, core::Vec3(3, 2, 0)), 8);
  sums.samplesPerHalf = 8;
  EXPECT_EQ(sums.mean().at(0, 0), core::Vec3(2, 2, 0));
  EXPECT_EQ(sums.half(1).at(0, 0), core::Vec3(3, 2, 0));
  EXPECT_DOUBLE_EQ(sums.relmse(), 1 / (4 + core::kRelativeEpsilon) / 3);
}

// A reference states what the true picture would score against it. A picture of far more samples under
// another seed stands for the truth; its own error adds to the difference. The scatter of the pixels gives
// the standard error.
TEST_F(References, TheStatedErrorIsTheRealOne) {
  ReferenceView v = view(40, 40);
  v.transport =
      raytrace::Transport::diffuse;  // without caustics, whose rare bright paths 64 samples may not meet
  ReferenceView other = v;
  other.seed = 2;
  const Reference a = compute(v, passable());
  const Reference truth = compute(other, {.relmse = a.own.relmse / 8, .capSeconds = 1e6});
  const core::ImageRgb half = readSums(fileOf(v), a.key, 40, 40).half(0);
  double sum = 0, squares = 0, real = 0;
  for (std::size_t i = 0; i < half.pixels().size(); ++i) {
    double pixel = 0;
    for (int c = 0; c < 3; ++c) {
      const double m = a.radiance.pixels()[i][c], weight = 1 / (m * m + core::kRelativeEpsilon) / 3;
      const double error = m - truth.radiance.pixels()[i][c], estimate = m - half.pixels()[i][c];
      pixel += (error * error - estimate * estimate) * weight;
      real += error * error * weight;
    }
    sum += pixel;
    squares += pixel * pixel;
  }
  const auto n = static_cast<double>(half.pixels().size());
  const double difference = sum / n, standardError = std::sqrt((squares / n - difference * difference) / n);
  ASSERT_LT(standardError, 0.2 * a.own.relmse) << "too few pixels to judge";
  EXPECT_NEAR(difference, truth.own.relmse, 3 * standardError) << "real " << real / n;
}

}  // namespace
}  // namespace saccade::bench
