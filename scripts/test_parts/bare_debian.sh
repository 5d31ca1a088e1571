# Sourced: a bare Debian 12 in the folder $root, made by debootstrap, in which `inside COMMAND...` runs; it is gone when
# the script ends. MIRROR names the archive of Debian packages (default: that of this system).
for tool in debootstrap chroot; do
  command -v "$tool" >/dev/null || { echo "$tool is missing: apt install $tool" >&2; exit 2; }
done
[ "$(id -u)" = 0 ] || { echo "debootstrap and chroot need root" >&2; exit 2; }

root=$(mktemp -d)
chmod 755 "$root"  # apt reads as a user of its own
remove_bare_debian() {
  local mounted
  for mounted in dev/shm dev sys proc; do
    # At once, though a daemon of Open MPI may still end.
    ! mountpoint -q "$root/$mounted" || umount -l "$root/$mounted"
  done
  rm -rf --one-file-system "$root"
}
trap remove_bare_debian EXIT

echo "== a bare Debian 12"
# shellcheck disable=SC2016  # the tool's own variable
debootstrap --variant=minbase bookworm "$root" \
  "${MIRROR:-$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -n 1)}" >/dev/null
rm "$root/etc/apt/sources.list"
cp -r /etc/apt/. "$root/etc/apt/"
cp -L /etc/resolv.conf "$root/etc/resolv.conf" 2>/dev/null || true
# Every system has it; without, each start of MPI waits for an answer to what its own name is.
cp -L /etc/hosts "$root/etc/hosts"
mount -t proc proc "$root/proc"
mount -t sysfs sysfs "$root/sys"
mount --bind /dev "$root/dev"
mount --make-private "$root/dev"  # what is mounted in it is not in this system's
mount -t tmpfs tmpfs "$root/dev/shm"

inside() { chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"; }
