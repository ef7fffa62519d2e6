#!/usr/bin/env bash
# Tests of the viewer: types, units, and the page in a browser. What is missing is said, and skipped.
set -euo pipefail
cd "$(dirname "$0")"

if ! command -v npm > /dev/null; then
  echo "SKIPPED: the viewer was not tested, for npm is not installed"
  exit 0
fi
npm run --silent check
npm run --silent unit

found=
for browser in "${CHROMIUM:-}" /usr/bin/chromium /usr/bin/chromium-browser /usr/bin/google-chrome; do
  if [ -x "$browser" ]; then found=$browser; break; fi
done
if [ -z "$found" ]; then
  echo "SKIPPED: the page was not tested in a browser, for there is no Chromium; install it, or say where it is: CHROMIUM=/path make test-viewer"
  exit 0
fi
CHROMIUM=$found npm run --silent browser
