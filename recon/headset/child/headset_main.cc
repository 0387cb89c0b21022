// The headset program: it lies beside the one that people start, which runs it while an OpenXR headset is
// used.
#include "recon/headset/child/headset_server.h"

int main() { elbowroom::recon::ServeHeadset(); }
