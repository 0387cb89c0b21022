// Texts of a window that no translator gets to see.
#pragma once

#include <QSet>
#include <QStringList>
#include <QTranslator>
#include <QWidget>

namespace elbowroom::console {

// Writes each text that passes through tr() with accents on all of its letters, so that a text without them
// didn't. Placeholders and tags stay.
class AccentTranslator : public QTranslator {
 public:
  [[nodiscard]] bool isEmpty() const override { return false; }
  [[nodiscard]] QString translate(const char* context, const char* source, const char* disambiguation,
                                  int n) const override;
};

// A line for each text of `top` that has a word of at least two letters without accents which isn't in
// `known`: names of parts and files, units; a single letter is a key or an axis. Looks at all that is shown,
// its tips and spoken names, and at all menus; not at the widgets named in `english`, which show what rooms
// without Qt say.
[[nodiscard]] QStringList UntranslatedTexts(const QWidget& top, const QSet<QString>& known,
                                            const QSet<QString>& english);

}  // namespace elbowroom::console
