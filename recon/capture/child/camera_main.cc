// The camera program: it lies beside the one that people start, which runs one for each live camera.
#include "recon/capture/child/camera_server.h"

int main() { elbowroom::recon::ServeCamera(); }
