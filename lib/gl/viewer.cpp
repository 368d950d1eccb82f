#include "cmap/gl/viewer.hpp"

#include <fmt/format.h>
#include <vtkActor2D.h>
#include <vtkAutoInit.h>
#include <vtkCallbackCommand.h>
#include <vtkImageData.h>
#include <vtkImageMapper.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "cmap/core/error.hpp"
#include "viewer_model.hpp"

VTK_MODULE_INIT(vtkInteractionStyle)
VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingUI)

namespace cmap {
namespace {

using Clock = std::chrono::steady_clock;

/// The window: hands what the user does to the model and shows what that draws. Events only note what is to be drawn;
/// a timer draws it, so that many moves of the mouse become one picture.
class ViewerWindow {
 public:
  explicit ViewerWindow(const ViewerScene& scene);
  ViewerWindow(const ViewerWindow&) = delete;
  ViewerWindow& operator=(const ViewerWindow&) = delete;

  void run();

 private:
  /// Calls a function of this class for an event of VTK; the first exception ends the loop and is thrown by run().
  void on(unsigned long event, void (ViewerWindow::*handle)());

  void press_left();
  void press_middle() { begin_drag(ViewerModel::Drag::kPan); }
  void press_right() { begin_drag(ViewerModel::Drag::kZoom); }
  void release();
  void move();
  void wheel_forward() { zoom(1.2); }
  void wheel_backward() { zoom(1.0 / 1.2); }
  void key();
  void configure();
  void tick();

  void begin_drag(ViewerModel::Drag drag);
  void zoom(double factor);
  void moved();
  void pick(int x, int y);
  void save();
  void show(const Image& image);
  int x() const { return interactor_->GetEventPosition()[0]; }
  int y() const { return window_->GetSize()[1] - 1 - interactor_->GetEventPosition()[1]; }  // from the top

  ViewerModel model_;
  vtkNew<vtkRenderWindow> window_;
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkRenderWindowInteractor> interactor_;
  vtkNew<vtkImageData> picture_;
  vtkNew<vtkImageMapper> mapper_;
  vtkNew<vtkActor2D> actor_;
  std::optional<ViewerModel::Drag> drag_;
  bool is_click_ = false;
  int press_x_ = 0, press_y_ = 0, last_x_ = 0, last_y_ = 0;
  bool coarse_due_ = false, fine_due_ = true;
  Clock::time_point last_move_;
  std::exception_ptr failure_;
};

ViewerWindow::ViewerWindow(const ViewerScene& scene) : model_(scene) {
  constexpr unsigned long kTick_ms = 10;
  mapper_->SetInputData(picture_);
  mapper_->SetColorWindow(255.0);
  mapper_->SetColorLevel(127.5);
  actor_->SetMapper(mapper_);
  renderer_->AddActor2D(actor_);
  window_->AddRenderer(renderer_);
  window_->SetMultiSamples(0);
  window_->SetSize(scene.options.width_px, scene.options.height_px);
  interactor_->SetRenderWindow(window_);
  interactor_->SetInteractorStyle(nullptr);
  on(vtkCommand::LeftButtonPressEvent, &ViewerWindow::press_left);
  on(vtkCommand::MiddleButtonPressEvent, &ViewerWindow::press_middle);
  on(vtkCommand::RightButtonPressEvent, &ViewerWindow::press_right);
  for (const auto event : {vtkCommand::LeftButtonReleaseEvent, vtkCommand::MiddleButtonReleaseEvent,
                           vtkCommand::RightButtonReleaseEvent}) {
    on(event, &ViewerWindow::release);
  }
  on(vtkCommand::MouseMoveEvent, &ViewerWindow::move);
  on(vtkCommand::MouseWheelForwardEvent, &ViewerWindow::wheel_forward);
  on(vtkCommand::MouseWheelBackwardEvent, &ViewerWindow::wheel_backward);
  on(vtkCommand::KeyPressEvent, &ViewerWindow::key);
  on(vtkCommand::ConfigureEvent, &ViewerWindow::configure);
  on(vtkCommand::TimerEvent, &ViewerWindow::tick);
  tick();
  interactor_->Initialize();
  interactor_->CreateRepeatingTimer(kTick_ms);
}

void ViewerWindow::on(unsigned long event, void (ViewerWindow::*handle)()) {
  // Exceptions must not pass through VTK's event loop.
  auto guarded = [this, handle] {
    try {
      if (failure_ == nullptr) (this->*handle)();
    } catch (...) {
      failure_ = std::current_exception();
      interactor_->TerminateApp();
    }
  };
  using Guarded = decltype(guarded);
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(new Guarded(guarded));
  command->SetClientDataDeleteCallback([](void* data) { delete static_cast<Guarded*>(data); });
  command->SetCallback([](vtkObject*, unsigned long, void* data, void*) { (*static_cast<Guarded*>(data))(); });
  interactor_->AddObserver(event, command);
}

void ViewerWindow::run() {
  interactor_->Start();
  if (failure_ != nullptr) std::rethrow_exception(failure_);
}

void ViewerWindow::press_left() {
  begin_drag(interactor_->GetShiftKey() != 0 ? ViewerModel::Drag::kPan : ViewerModel::Drag::kTurn);
  is_click_ = true;
}

void ViewerWindow::begin_drag(ViewerModel::Drag drag) {
  drag_ = drag;
  is_click_ = false;
  press_x_ = last_x_ = x();
  press_y_ = last_y_ = y();
}

void ViewerWindow::move() {
  constexpr int kStillAClick_px = 4;
  if (!drag_) return;
  if (std::max(std::abs(x() - press_x_), std::abs(y() - press_y_)) >= kStillAClick_px) is_click_ = false;
  if (is_click_) return;
  model_.drag(*drag_, x() - last_x_, y() - last_y_);
  last_x_ = x();
  last_y_ = y();
  moved();
}

void ViewerWindow::release() {
  if (drag_ && is_click_) pick(x(), y());
  drag_.reset();
}

void ViewerWindow::zoom(double factor) {
  model_.zoom(factor);
  moved();
}

void ViewerWindow::moved() {
  coarse_due_ = true;
  last_move_ = Clock::now();
}

void ViewerWindow::pick(int x, int y) {
  for (const std::string& line : model_.pick(x, y)) fmt::print("{}\n", line);
  std::fflush(stdout);
  fine_due_ = true;
}

void ViewerWindow::save() {
  int number = 1;
  const auto name = [&] { return std::filesystem::path(fmt::format("cmap_view_{}.png", number)); };
  while (std::filesystem::exists(name())) ++number;
  try {
    OutputFile file(name());
    write_image(model_.draw_plain(), name(), file);
    file.commit();
    model_.say(fmt::format("saved {}", name().string()));
  } catch (const OutputError& error) {
    model_.say(error.what());
  }
}

void ViewerWindow::key() {
  const char* name = interactor_->GetKeySym();
  if (name == nullptr) return;
  const std::string pressed = name;
  if (pressed == "p") return pick(x(), y());
  switch (model_.press(pressed)) {
    case ViewerModel::Answer::kNothing:
      return;
    case ViewerModel::Answer::kQuit:
      return interactor_->TerminateApp();
    case ViewerModel::Answer::kSave:
      save();
      [[fallthrough]];
    case ViewerModel::Answer::kRedraw:
      fine_due_ = true;
  }
}

void ViewerWindow::configure() {
  model_.resize(window_->GetSize()[0], window_->GetSize()[1]);
  moved();
}

void ViewerWindow::tick() {
  constexpr auto kRest = std::chrono::milliseconds(150);
  if (coarse_due_) {
    coarse_due_ = false;
    fine_due_ = true;
    show(model_.draw(true));
  } else if (fine_due_ && Clock::now() - last_move_ > kRest) {
    fine_due_ = false;
    show(model_.draw(false));
  }
}

void ViewerWindow::show(const Image& image) {
  picture_->SetDimensions(image.width, image.height, 1);
  picture_->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < image.height; ++y) {
    auto* out = static_cast<std::uint8_t*>(picture_->GetScalarPointer(0, image.height - 1 - y, 0));
    for (int x = 0; x < image.width; ++x, out += 3) std::copy_n(image.at(x, y).data(), 3, out);
  }
  picture_->Modified();
  // A window smaller than the smallest picture shows its upper left part.
  actor_->SetDisplayPosition(0, window_->GetSize()[1] - image.height);
  window_->SetWindowName(model_.title().c_str());
  window_->Render();
}

}  // namespace

void view(const ViewerScene& scene) {
  require_display();
  ViewerWindow(scene).run();
}

}  // namespace cmap
