#include "rendering/app/demo_app.h"

#include <GLFW/glfw3.h>

#include <sys/resource.h>

#include <algorithm>
#include <utility>

#include "engine/live/pacer.h"
#include "scenes/scene/scene.h"
#include "scenes/worker/model_worker.h"

namespace palpate {
namespace {

constexpr double kToast_s = 6.0;
constexpr double kProblemToast_s = 12.0;
constexpr std::size_t kMostToasts = 3;
constexpr int kPictureNice = 5;

DemoApp& app_of(GLFWwindow* handle) { return *static_cast<DemoApp*>(glfwGetWindowUserPointer(handle)); }

}  // namespace

Result<std::unique_ptr<DemoApp>> DemoApp::create(const DemoRequest& request) {
  std::unique_ptr<DemoApp> app(new DemoApp);
  if (const Status status = app->set_up(request); !status) return status.error();
  return app;
}

Status DemoApp::set_up(const DemoRequest& request) {
  view_.exhibit.on = request.exhibit;
  view_.settings.theme = request.exhibit ? Theme::dark : Theme::light;
  // Reports a missing display before anything else starts.
  if (Status status = Window::find_display(); !status) return status;
  request_ = request.session;
  if (request.exhibit && request_.models.empty()) request_.models = exhibit_models();
  if (const auto folder = data_folder()) request_.data_folder = *folder;
  files_.use_settings(view_.exhibit.on ? "" : request.settings_file);
  first_device_ = request_.device.rfind("replay:", 0) == 0 ? "auto" : request_.device;
  auto session = LiveSession::open(request_);
  if (!session) return session.error();
  session_ = std::move(*session);
  Window::at_loss_of_display([this] { end(); });
  // If real-time priority was refused, lowers the priority of the picture instead, which needs no privilege.
  if (!session_->loop().scheduling().realtime) setpriority(PRIO_PROCESS, 0, kPictureNice);
  // The window is opened after the haptics thread, because the driver's threads inherit the priority of this one.
  WindowRequest asked = request.window;
  asked.empty = palette(view_.settings.theme).background;
  auto window = Window::open(asked);
  if (!window) return window.error();
  window_ = std::move(*window);
  auto blocks = BlockView::create(session_->scene(), view_.exhibit.on ? 1.0F : kDeeperDents);
  if (!blocks) return blocks.error();
  blocks_ = std::move(*blocks);
  blocks_->in_one_row(view_.exhibit.on);
  if (Status status = set_up_exhibit(request.exhibit_times); !status) return status;
  commands_ = make_commands();
  actions_ = make_actions();
  listen();
  if (find_font().empty()) notify("no font found; install fonts-dejavu-core", true);
  for (const std::string& recording : request.recordings) files_.open_recording(recording);
  view_.time.zero_s = last_frame_s_ = steady_now_s();
  look();
  return {};
}

void DemoApp::listen() {
  GLFWwindow* handle = window_->handle();
  glfwSetWindowUserPointer(handle, this);
  glfwSetDropCallback(handle, [](GLFWwindow* from, int count, const char** paths) {
    app_of(from).drop_files({paths, paths + count});
  });
  glfwSetKeyCallback(handle, [](GLFWwindow* from, int key, int, int action, int modifiers) {
    app_of(from).handle_key_event(key, action, modifiers);
  });
  // Their values are ImGui's; here they are only signs of a user.
  glfwSetMouseButtonCallback(handle, [](GLFWwindow* from, int, int, int) { app_of(from).note_input(); });
  glfwSetScrollCallback(handle, [](GLFWwindow* from, double, double) { app_of(from).note_input(); });
  glfwSetCharCallback(handle, [](GLFWwindow* from, unsigned) { app_of(from).note_input(); });
  // After these callbacks: ImGui installs its own and calls them.
  ui_ = std::make_unique<UiContext>(handle);
}

std::string DemoApp::end() {
  if (session_ == nullptr) return "";
  std::string stats = stats_text(*session_, shown_, view_.frames);
  session_->close();
  return stats;
}

void DemoApp::finish() {
  if (window_ != nullptr) glfwHideWindow(window_->handle());
  if (session_ == nullptr) return;
  files_.save_settings();
  session_->close();
  files_.finish();
}

DemoApp::~DemoApp() {
  finish();
  session_.reset();
  blocks_.reset();
  Window::at_loss_of_display(nullptr);
}

bool DemoApp::closing() const noexcept {
  return view_.exhibit.on ? leaving_ : glfwWindowShouldClose(window_->handle()) != 0;
}

void DemoApp::close() {
  leaving_ = true;
  glfwSetWindowShouldClose(window_->handle(), GLFW_TRUE);
}

void DemoApp::drop_files(const std::vector<std::string>& paths) {
  if (view_.exhibit.on) return;
  note_input();
  for (const std::string& path : paths) files_.open(path, *session_);
}

void DemoApp::note_input() {
  constexpr double kLively_s = 0.3;  // a list opens, takes the focus and is laid out within a few frames
  lively_until_s_ = steady_now_s() + kLively_s;
}

void DemoApp::frame() {
  if (session_ == nullptr) return;  // the program is closing
  glfwPollEvents();
  session_->update();
  read_notices();
  files_.update(*session_);
  look();
  blocks_->camera().advance(static_cast<float>(window_->frame_s()));
  if (window_->is_visible()) draw(needs_texts(steady_now_s()));
  handle_keys();
  // The session changes between two frames, because drawing refers to it.
  if (next_) reopen(*std::exchange(next_, std::nullopt));
  const std::string picture = std::exchange(picture_, "");
  if (picture.empty() || !window_->is_visible()) {
    window_->show_frame();
  } else {
    const Status saved = window_->save_frame(picture, false);
    notify(saved ? "saved " + picture : saved.error().message, !saved);
  }
  const double shown_s = steady_now_s();
  view_.frames.add(shown_s - last_frame_s_);
  last_frame_s_ = shown_s;
}

void DemoApp::look() { shown_ = window_view(*session_, view_); }

void DemoApp::read_notices() {
  for (const Notice& notice : session_->read_notices()) notify(notice.text, notice.problem);
  std::erase_if(view_.toasts, [&](Toast& toast) { return (toast.left_s -= window_->frame_s()) < 0.0; });
  if (view_.toasts.size() > kMostToasts) view_.toasts.erase(view_.toasts.begin(), view_.toasts.end() - kMostToasts);
}

void DemoApp::notify(std::string text, bool problem) {
  if (view_.exhibit.on) {  // visitors do not see it
    DemoFiles::write_to_log(text);
    return;
  }
  std::erase_if(view_.toasts, [&](const Toast& toast) { return toast.text == text; });
  view_.toasts.push_back({{std::move(text), problem}, problem ? kProblemToast_s : kToast_s});
}

// Opens another material and fits models to it; models from files are kept.
void DemoApp::use_material(const std::string& scene, const std::vector<std::string>& recordings,
                           const std::string& device) {
  next_ = request_;
  next_->scene = scene;
  next_->recordings = recordings;
  next_->device = device;
  next_->test.clear();
  next_->models.clear();
  next_->kept = session_->models().requests();
  next_->refits = true;
  std::erase_if(next_->kept, [](const ModelRequest& plan) { return !plan.is_file(); });
  for (ModelRequest& plan : next_->kept) plan.of_this_material = false;
  if (next_->line_up.empty()) next_->line_up = line_ups().front().name;
}

// Changes the device and keeps material and models; no model is fitted again.
void DemoApp::use_device(const std::string& device) {
  next_ = request_;
  next_->recordings = session_->scene().recordings;
  // The test of the hand is that of the replay before.
  next_->test = device.rfind("replay:", 0) == 0 || session_->tests_training() ? "" : session_->test_file();
  next_->device = device;
  next_->kept = session_->models().requests();
  next_->refits = next_->kept.empty();
  next_->line_up = session_->line_up();
}

void DemoApp::use_recording_roles() {
  const RecordingRoles roles = std::exchange(view_.dialogs.recording_roles, {});
  const std::string test = roles.tested.empty() ? "" : "replay:" + roles.tested;
  if (!roles.training().empty()) {
    use_material(request_.scene, roles.training(), test.empty() ? "replay:" + roles.training().back() : test);
  } else if (!test.empty()) {
    use_device(test);
  }
}

void DemoApp::reopen(const SessionRequest& request) {
  view_.toasts.clear();
  // A device belongs to one session at a time.
  session_.reset();
  // The previous session may fail as well, if its device or its files are gone.
  SessionRequest without_device = request_;
  without_device.device = "mouse";
  const SessionRequest plain{.device = "mouse", .realtime = request_.realtime, .data_folder = request_.data_folder};
  for (SessionRequest wanted : {request, request_, without_device, plain}) {
    wanted.known_device = wanted.device == request_.device;
    auto session = LiveSession::open(wanted);
    if (session) {
      request_ = wanted;
      session_ = std::move(*session);
      break;
    }
    notify(session.error().message, true);
    outcome_ = session.error();
  }
  if (session_ == nullptr) return close();
  outcome_ = {};
  auto blocks = BlockView::create(session_->scene());
  if (blocks) blocks_ = std::move(*blocks);
  curves_ = {};  // without those of the old session
  stroke_.reset();
  view_.time = {.zero_s = steady_now_s()};
  view_.scales_force = view_.material = false;
  view_.worst.reset();
  view_.second = kReferenceBlock;
  look();
}

WindowActions DemoApp::make_actions() {
  WindowActions actions;
  actions.commands = &commands_;
  actions.choices = [this] { return choices(); };
  actions.select = [this](std::size_t slot) {
    view_.material = false;
    (void)session_->models().select(slot);
  };
  actions.models = [this]() -> SessionModels& { return session_->models(); };
  actions.worst = [this](std::size_t slot) { use_worst(slot); };
  actions.scale = [this](const ForceScale& scale) { session_->controls().scale = scale; };
  actions.zero_device = [this] { session_->start_zeroing(); };
  actions.look_for_devices = [this] { files_.look_for_devices(); };
  actions.move_surface = [this](bool moved) { session_->move_surface(moved); };
  actions.use_scene = [this](const std::string& scene) { use_material(scene, {}, first_device_); };
  actions.open = [this](const std::string& path) { drop_files({path}); };
  actions.use_device = [this](const std::string& device) {
    first_device_ = device;
    use_device(device);
  };
  actions.use_recording_roles = [this] { use_recording_roles(); };
  actions.exports = {{"Picture (PNG)", [this] { picture_ = files_.picture_path(); }},
                     {"Curves (SVG, CSV)", [this] { files_.save_curves(*session_, shown_, curves_.columns()); }},
                     {"Table (CSV)", [this] { files_.save_table(shown_); }},
                     {"Copy the table",
                      [this] {
                        glfwSetClipboardString(window_->handle(), table_csv(shown_.models).c_str());
                        notify("the table is in the clipboard", false);
                      }},
                     {"Active model (JSON)", [this] { files_.save_model(*session_); }}};
  actions.lift_tool = [this] { lift_tool(); };
  actions.reset_figures = [this] { session_->reset_figures(); };
  return actions;
}

Status DemoApp::set_up_exhibit(const ExhibitTimes& times) {
  if (!view_.exhibit.on) return {};
  const auto assets = find_assets();
  if (!assets) return assets.error();
  auto languages = read_exhibit_words(*assets + "/exhibit");
  if (!languages) return languages.error();
  const auto folder = data_folder();
  exhibit_.set_up(std::move(*languages), folder ? *folder : "", times);
  return {};
}

Status DemoApp::screenshot(const std::string& path, bool overwrite) {
  panel_waits_ = false;
  draw(true);
  return window_->save_frame(path, overwrite);
}

}  // namespace palpate
