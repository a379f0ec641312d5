#include "scenes/study/live_study.h"

#include <array>
#include <utility>

#include "devices/registry/device_registry.h"
#include "scenes/scene/assets.h"

namespace palpate {

Result<std::unique_ptr<LiveStudy>> LiveStudy::open(const std::string& device, bool realtime,
                                                   std::shared_ptr<const StrokePair> strokes) {
  DeviceRequest request;
  if (const auto assets = find_assets()) request.calibrations = *assets + "/devices";
  auto opened = open_device(device, request);
  if (!opened) return opened.error();
  std::unique_ptr<LiveStudy> study(new LiveStudy);
  study->realtime_ = realtime;
  study->device_ = std::move(*opened);
  study->header_ = {"", std::move(strokes), study->device_->name(), study->device_->holder() == Holder::person};
  return study;
}

LiveStudy::~LiveStudy() {
  loop_.reset();
  device_->close();
}

Status LiveStudy::begin(const std::string& code) {
  header_.subject = code;
  if (const Status checked = check_subject_code(code); !checked) return checked;
  auto file = StudyFile::open((strokes() != nullptr ? "discriminate-" : "study-") + code + ".csv", header_);
  if (!file) return file.error();
  auto session = StudySession::create(std::move(*file));
  if (!session) return session.error();
  session_ = std::move(*session);
  LoopSettings settings;
  settings.realtime = realtime_;
  settings.source = session_.get();
  auto loop = std::make_unique<HapticsLoop>(*device_, settings);
  if (const Status started = loop->start(); !started) return started;
  loop_ = std::move(loop);
  return {};
}

void LiveStudy::update() {
  if (loop_ == nullptr) return;
  newest_ = loop_->newest();
  // The presenter records the forces; the snapshots are discarded, so that the ring does not fill up.
  std::array<LoopSnapshot, 64> passed;
  while (loop_->read_snapshots(passed.data(), passed.size()) == passed.size()) {
  }
  session_->update();
}

std::string LiveStudy::device_words() const {
  const auto faults = device_fault_words(newest_.device.faults);
  if (!faults.empty()) return faults.front();
  const std::string zeroing = zeroing_words(newest_.device);
  return zeroing.empty() ? device_->note() : zeroing;
}

}  // namespace palpate
