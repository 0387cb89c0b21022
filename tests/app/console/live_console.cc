// The console's window with live cameras, without a person, on whatever screen Qt finds; together with
// serve_demo.
//   live_console trial FILE SESSION.db SECONDS [PICTURE.png]   runs a trial; prints as JSON how old the
//   operator's
//     pictures were when they were painted, how long each took to draw, and how much processor time went
//     where
//   live_console preflight FILE SECONDS PICTURE.png            checks the cameras, and takes a picture
// FILE is a TRIAL.toml, or a RIG.yml whose live cameras see the demo's parts.
#include <unistd.h>

#include <QAction>
#include <QApplication>
#include <QTimer>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/console/console_main.h"
#include "app/console/desktop/theme.h"
#include "app/console/main_window.h"
#include "app/control/demo_trial.h"
#include "cad_import/import_worker.h"
#include "core/spread.h"
#include "recon/capture/live_rig.h"

namespace {

using namespace elbowroom;

// From OpenGL's start to the second in which the light of all cameras was reported on.
constexpr std::chrono::seconds kWarmUp(5);

double TicksToSeconds(double ticks) { return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK)); }

// Of a process, all threads; 0: there is none.
double ProcessorSeconds(const std::string& pid) {
  std::ifstream file("/proc/" + pid + "/stat");
  std::string text;
  std::getline(file, text, ')');  // the number and the name, which may have blanks
  double user_ticks = 0.0, system_ticks = 0.0;
  constexpr int kFieldsBeforeTimes = 11;
  for (int i = 0; i < kFieldsBeforeTimes; ++i) file >> text;
  file >> user_ticks >> system_ticks;
  return TicksToSeconds(user_ticks + system_ticks);
}

double SecondsOfChildren() {
  double seconds = 0.0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream file(task.path() / "children");
    for (std::string pid; file >> pid;) seconds += ProcessorSeconds(pid);
  }
  return seconds;
}

// Of all processors, whoever uses them.
double SecondsOfMachine() {
  std::ifstream file("/proc/stat");
  std::string name;
  double user = 0.0, nice = 0.0, system = 0.0;
  file >> name >> user >> nice >> system;
  return TicksToSeconds(user + nice + system);
}

struct ProcessorTimes {
  double console_s = ProcessorSeconds("self");
  double camera_programs_s = SecondsOfChildren();
  double server_s = ProcessorSeconds(std::to_string(::getppid()));
  double machine_s = SecondsOfMachine();
};

nlohmann::json JsonOf(std::vector<double> values) {
  if (values.empty()) return nullptr;
  std::ranges::sort(values);
  const auto at = [&](double share) { return core::PercentileOf(values, share); };
  return {{"median", at(0.5)}, {"p95", at(0.95)}, {"p99", at(0.99)}, {"max", values.back()}};
}

// What the window told since the measurement began.
struct Measured {
  std::vector<double> verdict_ms, age_ms, drawing_ms;
  ProcessorTimes began;
};

nlohmann::json JsonOf(const Measured& measured, double seconds) {
  const ProcessorTimes now;
  const auto cores = [&](double from_s, double to_s) { return (to_s - from_s) / seconds; };
  return {{"seconds", seconds},
          {"pictures", measured.age_ms.size()},
          {"capture_to_verdict_in_window_ms", JsonOf(measured.verdict_ms)},
          {"capture_to_picture_ms", JsonOf(measured.age_ms)},
          {"drawing_ms", JsonOf(measured.drawing_ms)},
          {"busy_cores",
           {{"console", cores(measured.began.console_s, now.console_s)},
            {"camera_programs", cores(measured.began.camera_programs_s, now.camera_programs_s)},
            {"parent", cores(measured.began.server_s, now.server_s)},
            {"machine", cores(measured.began.machine_s, now.machine_s)}}}};
}

console::TrialDesk::SetupReader ReaderOf(const std::filesystem::path& file) {
  if (file.extension() == ".toml")
    return [file](const std::stop_token& stop) { return control::ReadTrialFile(file, stop); };
  return [file](const std::stop_token& stop) {
    control::TrialSetup setup = control::MakeDemoTrial(control::DemoPlay::kForever);
    setup.source = std::make_shared<recon::LiveRig>(recon::ReadRigFile(file), recon::LiveTaps(), stop);
    return setup;
  };
}

// Checks the cameras of the file for so long, and takes a picture of the window.
int ShowPreflight(console::MainWindow& window, const std::vector<std::string>& words) {
  console::PreflightPanel& panel = window.preflight();
  window.findChild<QAction*>("show_preflight")->trigger();
  QObject::connect(&panel, &console::PreflightPanel::RigChanged, &window, [&] {
    if (panel.CanCheck() && panel.rows().size() < 4) panel.Check(std::stod(words.at(2)));
  });
  QObject::connect(&panel, &console::PreflightPanel::Checked, &window, [&] {
    QTimer::singleShot(std::chrono::milliseconds(200), &window, [&] {  // the table has its rows' heights then
      window.grab().save(QString::fromStdString(words.at(3)), "PNG");
      QApplication::exit(EXIT_SUCCESS);
    });
  });
  panel.Open(words.at(1));
  return QApplication::exec();
}

int MeasureTrial(console::MainWindow& window, const std::vector<std::string>& words) {
  const double seconds = std::stod(words.at(3));
  Measured measured;
  std::string error;
  QObject::connect(&window.desk(), &console::TrialDesk::Failed, &window, [&](const QString& line) {
    error = line.toStdString();
    window.close();
  });
  QObject::connect(&window.view(), &console::OperatorView::PictureSeen, &window,
                   [&](qint64, double age_ms) { measured.age_ms.push_back(age_ms); });
  QObject::connect(&window.view(), &console::OperatorView::PictureShown, &window,
                   [&](qint64, double drawing_ms) { measured.drawing_ms.push_back(drawing_ms); });
  const auto finish = [&] {
    std::cout << JsonOf(measured, seconds).dump(2) << std::endl;
    if (words.size() > 4) window.grab().save(QString::fromStdString(words[4]), "PNG");
    window.close();
  };
  bool has_begun = false;
  QObject::connect(&window.desk(), &console::TrialDesk::FrameArrived, &window,
                   [&](const console::FrameNews& news) {
                     const std::chrono::duration<double, std::milli> age =
                         std::chrono::steady_clock::now() - news.result->camera_frames->taken_at.value();
                     measured.verdict_ms.push_back(age.count());
                     if (std::exchange(has_begun, true)) return;
                     QTimer::singleShot(kWarmUp, &window, [&] {
                       measured = {};
                       QTimer::singleShot(static_cast<int>(1000.0 * seconds), &window, finish);
                     });
                   });
  window.desk().Start(ReaderOf(words.at(1)), words.at(2));
  QApplication::exec();
  if (!error.empty()) std::cerr << error << "\n";
  return error.empty() && !measured.age_ms.empty() ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  cad_import::ServeImport(argc, argv);
  const QApplication application(argc, argv);
  console::SetTheme(console::Theme::kLight);
  const std::vector<std::string> words(argv + 1, argv + argc);
  console::MainWindow window;
  window.show();
  try {
    if (words.size() >= 4 && words[0] == "trial") return MeasureTrial(window, words);
    if (words.size() == 4 && words[0] == "preflight") return ShowPreflight(window, words);
  } catch (const std::exception& failure) {
    std::cerr << failure.what() << "\n";
    return EXIT_FAILURE;
  }
  std::cerr << "usage: live_console trial FILE SESSION.db SECONDS [PICTURE.png]\n"
               "       live_console preflight FILE SECONDS PICTURE.png\n";
  return 2;
}
