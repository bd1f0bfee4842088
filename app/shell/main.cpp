#include "app/shell/cli.h"

int main(int argc, char** argv) {
  return glidelab::app::run(argc, argv);
}
