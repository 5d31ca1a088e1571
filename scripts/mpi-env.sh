# Sourced by the scripts that start MPI programs: what Open MPI 4 and 5 need where it refuses by default.

# As root, as in most containers.
if [ "$(id -u)" = 0 ]; then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  export PRTE_ALLOW_RUN_AS_ROOT=1 PRTE_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi

# More ranks than cores: permit it and let waiting ranks give the core away.
if [ "$(nproc)" -lt "${FLUXEL_RANKS:-2}" ]; then
  export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1
  export PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
fi

# Containers forbid process_vm_readv, by which ranks of one host read from each other.
if [ -e /.dockerenv ] || [ -e /run/.containerenv ] || [ -n "${container:-}" ] ||
  grep -qsE 'docker|kubepods|containerd|lxc' /proc/1/cgroup; then
  export OMPI_MCA_btl_vader_single_copy_mechanism=none
fi
