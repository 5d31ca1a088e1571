# Sourced by scripts/test and scripts/test-more: steps, and tests that are counted. The last line of either is
# `N passed, M failed`, over all tests that ran; a step that fails without a failed test counts as one.
exec </dev/null
FLUXEL_RANKS=7 source scripts/mpi-env.sh

passed=0
failed=0
logs=build/logs
mkdir -p "$logs"

finish() {
  local status=$?
  echo "$passed passed, $failed failed"
  exit "$status"
}
trap finish EXIT
trap 'exit 1' INT TERM

step() {
  local name=$1 start=$SECONDS before=$failed
  shift
  echo "== $name"
  if "$@"; then
    echo "== $name: ok, $((SECONDS - start)) s"
  else
    echo "== $name: FAILED, $((SECONDS - start)) s"
    [ "$failed" != "$before" ] || failed=$((failed + 1))
    exit 1
  fi
}

# run_tests FOLDER OPTION...: ctest there, a line for each set of tests, its counts added to the totals.
run_tests() {
  local log status total bad
  log=$logs/ctest-$(echo "$*" | tr -c 'a-zA-Z0-9\n' '-').log
  ctest --test-dir "$@" --output-on-failure --no-tests=error --parallel "$(nproc)" 2>&1 | tee "$log" |
    grep --line-buffered -vE '^ *Start |^$|^Internal ctest|^Test project'
  status=${PIPESTATUS[0]}
  read -r bad total < <(sed -nE 's/.*tests passed, ([0-9]+) tests? failed out of ([0-9]+).*/\1 \2/p' "$log")
  passed=$((passed + ${total:-0} - ${bad:-0}))
  failed=$((failed + ${bad:-0}))
  return "$status"
}

# run_shards PROGRAM OPTION...: a program of Google Test in a part for each core, of 16 at most, started once: for each
# test anew it takes twice as long and more. Of `turns` (1 unless set), those of the tests whose `turn` it is.
run_shards() {
  local program=$1 shards log k pids=() status=0 ended ran bad all first before=$passed
  shift
  shards=$(($(nproc) < 16 ? $(nproc) : 16))
  all=$((shards * ${turns:-1}))
  first=$((shards * (${turn:-1} - 1)))
  for ((k = 0; k < shards; ++k)); do
    GTEST_TOTAL_SHARDS=$all GTEST_SHARD_INDEX=$((first + k)) timeout 1800 "$program" --gtest_brief=1 "$@" >"$logs/shard-$k.log" 2>&1 &
    pids+=($!)
  done
  for ((k = 0; k < shards; ++k)); do
    log=$logs/shard-$k.log
    wait "${pids[$k]}"
    ended=$?
    ran=$(sed -nE 's/^\[=+\] ([0-9]+) tests? from .* ran\..*/\1/p' "$log")
    if [ "$ended" = 0 ] && [ -n "$ran" ]; then
      passed=$((passed + ran))
      echo "part $((k + 1)) of $shards: $ran tests passed"
    else
      # A crash, or a leak that is found at the end, is a failure of its own.
      bad=$(sed -nE 's/^\[  FAILED  \] ([0-9]+) tests?, listed below.*/\1/p' "$log")
      failed=$((failed + ${bad:-1}))
      status=1
      tail -n 60 "$log"
    fi
  done
  if [ "$passed" = "$before" ]; then
    echo "no test of $program ran"
    return 1
  fi
  return "$status"
}
