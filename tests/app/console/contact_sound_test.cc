// What is heard of a contact, by a real sound server whose loudspeaker is recorded.
#include <gtest/gtest.h>

#include <QApplication>
#include <QProcess>
#include <QSignalSpy>
#include <QTest>
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "app/console/procedure/contact_sound.h"
#include "app/console/procedure/procedure_panel.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::console {
namespace {

constexpr int kSoundPatienceMs = 60'000;

// PulseAudio with a loudspeaker that isn't there, and what comes out of it.
class SoundServer {
 public:
  SoundServer() {
    qputenv("PULSE_RUNTIME_PATH", QByteArray::fromStdString(folder_.path().string()));
    qputenv("PULSE_SERVER", QByteArray::fromStdString("unix:" + socket_.string()));
    Start();
  }
  ~SoundServer() {
    End(recorder_);
    End(server_);
  }

  void Start() {
    server_.start("pulseaudio", {"-n", "--daemonize=no", "--use-pid-file=no", "--exit-idle-time=-1", "-L",
                                 "module-null-sink sink_name=loudspeaker", "-L",
                                 QString("module-native-protocol-unix auth-anonymous=1 socket=%1")
                                     .arg(QString::fromStdString(socket_.string()))});
    ASSERT_TRUE(server_.waitForStarted());
    ASSERT_TRUE(QTest::qWaitFor([&] { return QProcess::execute("pactl", {"info"}) == 0; }, kSoundPatienceMs));
    recorder_.start("parec",
                    {"--device=loudspeaker.monitor", "--raw", "--format=s16le", "--latency-msec=20"});
    ASSERT_TRUE(QTest::qWaitFor([&] { return !Hear().isEmpty(); }, kSoundPatienceMs));
  }
  void Stop() {
    End(recorder_);
    End(server_);
    std::filesystem::remove(socket_);
  }

  // The largest of what came out since the last call, of 32767.
  int Peak() {
    const QByteArray heard = Hear();
    int peak = 0;
    for (qsizetype i = 0; i + 1 < heard.size(); i += 2) {
      std::int16_t sample = 0;
      std::memcpy(&sample, heard.data() + i, sizeof(sample));
      peak = std::max(peak, std::abs(int{sample}));
    }
    return peak;
  }

 private:
  QByteArray Hear() {
    recorder_.waitForReadyRead(10);
    return recorder_.readAllStandardOutput();
  }
  static void End(QProcess& process) {
    process.kill();
    process.waitForFinished();
  }

  test_support::TemporaryFolder folder_;
  std::filesystem::path socket_ = folder_ / "native";
  QProcess server_, recorder_;
};

std::vector<core::PartContact> OnePart(core::Verdict verdict) {
  core::PartContact contact;
  contact.verdict = verdict;
  return {contact};
}

class HeardContact : public testing::Test {
 protected:
  ~HeardContact() override { sound_.SetOn(false); }
  void Touch() {
    sound_.ShowFrame(OnePart(core::Verdict::kClear));
    sound_.ShowFrame(OnePart(core::Verdict::kContact));
  }
  // What came of the next sound.
  QString Trouble() {
    EXPECT_TRUE(QTest::qWaitFor([&] { return !played_.isEmpty(); }, kSoundPatienceMs));
    return played_.isEmpty() ? "nothing" : played_.takeFirst().front().toString();
  }

  ContactSound sound_;
  QSignalSpy played_{&sound_, &ContactSound::Played};
};

TEST_F(HeardContact, ComesOutOfTheLoudspeaker) {
  SoundServer server;
  constexpr int kAudible = 1000;
  EXPECT_EQ(server.Peak(), 0);
  sound_.SetOn(true);
  EXPECT_EQ(Trouble(), "");
  EXPECT_TRUE(QTest::qWaitFor([&] { return server.Peak() > kAudible; }, kSoundPatienceMs)) << "once, at first";
  ASSERT_TRUE(QTest::qWaitFor([&] { return server.Peak() == 0; }, kSoundPatienceMs)) << "and it ends";
  Touch();
  EXPECT_EQ(Trouble(), "");
  EXPECT_TRUE(QTest::qWaitFor([&] { return server.Peak() > kAudible; }, kSoundPatienceMs));

  server.Stop();
  Touch();
  EXPECT_NE(Trouble(), "");
  server.Start();
  Touch();
  EXPECT_EQ(Trouble(), "");
  EXPECT_TRUE(QTest::qWaitFor([&] { return server.Peak() > kAudible; }, kSoundPatienceMs)) << "after a restart";
}

TEST_F(HeardContact, ThatCannotBeHeardSaysSoAtItsSwitch) {
  qputenv("PULSE_SERVER", "unix:/nowhere");
  ProcedurePanel panel;
  QObject::connect(&sound_, &ContactSound::Played, &panel, &ProcedurePanel::ShowSound);
  sound_.SetOn(true);
  const QString trouble = Trouble();
  EXPECT_NE(trouble, "");
  EXPECT_TRUE(panel.sound()->text().contains("not heard"));
  EXPECT_TRUE(panel.sound()->toolTip().contains(trouble)) << panel.sound()->toolTip().toStdString();
  panel.ShowSound(QString());
  EXPECT_FALSE(panel.sound()->text().contains("not heard"));
}

}  // namespace
}  // namespace elbowroom::console
