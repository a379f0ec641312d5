#include "scenes/study/live_study.h"

#include <array>
#include <utility>

#include "devices/registry/device_registry.h"
#include "scenes/scene/assets.h"
#include "scenes/study/study_file.h"

namespace palpate {

namespace {

Result<std::unique_ptr<Device>> open_study_device(const std::string& name) {
  DeviceRequest request;
  if (const auto assets = find_assets()) request.calibrations = *assets + "/devices";
  return open_device(name, request);
}

}  // namespace

bool study_can_be_felt(const std::string& device) {
  const auto opened = open_study_device(device);
  if (!opened) return false;
  const bool felt = (*opened)->holder() == Holder::person;
  (*opened)->close();
  return felt;
}

Result<std::unique_ptr<LiveStudy>> LiveStudy::open(const LiveStudyRequest& request) {
  if (Status status = check_subject_code(request.header.subject); !status) return status.error();
  auto device = open_study_device(request.device);
  if (!device) return device.error();
  StudyHeader header = request.header;
  header.device = (*device)->name();
  header.rendered = (*device)->holder() == Holder::person;
  auto file = StudyFile::open(request.path, header);
  if (!file) return file.error();
  auto session = StudySession::create(header, std::move(*file));
  if (!session) return session.error();
  std::unique_ptr<LiveStudy> study(new LiveStudy(std::move(*device), std::move(*session)));
  LoopSettings settings;
  settings.realtime = request.realtime;
  settings.source = study->session_.get();
  study->loop_ = std::make_unique<HapticsLoop>(*study->device_, settings);
  if (Status status = study->loop_->start(); !status) return status.error();
  return study;
}

LiveStudy::LiveStudy(std::unique_ptr<Device> device, std::unique_ptr<StudySession> session)
    : device_(std::move(device)), session_(std::move(session)) {}

LiveStudy::~LiveStudy() {
  if (loop_ != nullptr) loop_->stop();
  loop_.reset();
  device_->close();
}

void LiveStudy::update() {
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
