// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/vtk_messages.h>

#include <vtkLogger.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <algorithm>
#include <mutex>
#include <sstream>

namespace sinew {
namespace {

thread_local VtkMessages* listener = nullptr;

/// VTK has one window for the messages of all threads: this one hands each to its thread's
/// listener, or to the window that was there before.
class ListeningWindow : public vtkOutputWindow {
 public:
  static ListeningWindow* New();
  vtkTypeMacro(ListeningWindow, vtkOutputWindow);

  void DisplayErrorText(const char* text) override {
    if (listener) return listener->add_error(text);
    before_->DisplayErrorText(text);
  }
  void DisplayText(const char* text) override {
    if (!listener) before_->DisplayText(text);
  }
  void DisplayWarningText(const char* text) override {
    if (!listener) before_->DisplayWarningText(text);
  }
  void DisplayGenericWarningText(const char* text) override {
    if (!listener) before_->DisplayGenericWarningText(text);
  }

 private:
  vtkSmartPointer<vtkOutputWindow> before_ = vtkOutputWindow::GetInstance();
};
vtkStandardNewMacro(ListeningWindow);

void install() {
  static std::once_flag once;
  std::call_once(once, [] {
    // The logger prints every error as well, before the window hears of it.
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    vtkOutputWindow::GetInstance()->SetDisplayModeToAlwaysStdErr();
    auto window = vtkSmartPointer<ListeningWindow>::New();
    vtkOutputWindow::SetInstance(window);
  });
}

/// "ERROR: In x.cxx, line 1\nvtkReader (0x5): message\n\n" -> "message".
std::string plain(std::string text) {
  if (const auto end = text.find("): "); end != std::string::npos) text.erase(0, end + 3);
  std::istringstream words(text);
  std::string line, word;
  while (words >> word) line += (line.empty() ? "" : " ") + word;
  return line.substr(0, 300);
}

}  // namespace

VtkMessages::VtkMessages() : outer_(listener) {
  install();
  listener = this;
}

VtkMessages::~VtkMessages() { listener = outer_; }

void VtkMessages::add_error(const std::string& text) {
  if (!failed()) first_error_ = plain(text);
  if (!failed()) first_error_ = "VTK gives no reason";
}

}  // namespace sinew
