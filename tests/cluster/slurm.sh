# A real Slurm on this machine alone, for tests; to be sourced. It needs no systemd, listens on loopback, keeps everything in one temporary folder, and
# runs beside others of its kind. Who sources it calls stop_slurm when it ends, whatever happens: trap stop_slurm EXIT.
# As root, so in a container, jobs run as root: this is for tests only. Without root all daemons are the user's own.
slurm_cores=2
PATH=$PATH:/usr/sbin:/sbin

why_no_slurm() { # a sentence, or nothing where Slurm can run
  local program
  for program in slurmctld slurmd sbatch munged setpriv; do
    command -v "$program" >/dev/null || { echo "there is no $program (scripts/setup --cluster)"; return; }
  done
  [ -n "$(ls -A /sys/fs/cgroup 2>/dev/null)" ] || echo "slurmd cannot run here: nothing is mounted at /sys/fs/cgroup"
}

free_port() { # below those that the kernel gives away
  local port
  while :; do
    port=$((20000 + RANDOM % 12000))
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || break
  done
  echo "$port"
}

as_munge() {
  if [ "$(id -u)" -eq 0 ]; then setpriv --reuid=munge --regid=munge --clear-groups "$@"; else "$@"; fi
}

write_slurm_conf() { # jobs an array may have, and one
  local host user
  host=$(hostname -s)
  user=$(id -un)
  # Requeued jobs wait for cred_expire, 5 s at least. Queued jobs are looked at each second.
  cat >"$SLURM_CONF" <<CONF
ClusterName=glocal_test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$slurm_folder/munge/socket,cred_expire=5
CredType=cred/munge
StateSaveLocation=$slurm_folder/state
SlurmdSpoolDir=$slurm_folder/spool
SlurmctldPidFile=$slurm_folder/slurmctld.pid
SlurmdPidFile=$slurm_folder/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
MailProg=/bin/true
ReturnToService=2
KillWait=5
MaxArraySize=$1
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
SlurmdParameters=config_overrides
NodeName=here NodeHostname=$host NodeAddr=127.0.0.1 CPUs=$slurm_cores
PartitionName=main Nodes=ALL Default=YES
CONF
}

start_munged() {
  local folder=$slurm_folder/munge
  mkdir -m 711 "$folder"
  head -c 128 /dev/urandom >"$folder/key"
  chmod 400 "$folder/key"
  [ "$(id -u)" -ne 0 ] || chown -R munge "$folder"
  as_munge munged --foreground --num-threads=2 --key-file="$folder/key" --socket="$folder/socket" --log-file="$folder/log" \
    --pid-file="$folder/pid" --seed-file="$folder/seed" >"$slurm_folder/munged.said" 2>&1 &
  munged_pid=$!
}
start_slurmctld() {
  slurmctld -D >>"$slurm_folder/slurmctld.said" 2>&1 &
  slurmctld_pid=$!
}
start_slurmd() {
  slurmd -D >>"$slurm_folder/slurmd.said" 2>&1 &
  slurmd_pid=$!
}

wait_for_slurm() { # until jobs can run
  local state
  for ((i = 0; i < 300; ++i)); do
    state=$(sinfo -h -o %t 2>/dev/null || true)
    case $state in idle | mix | alloc) return ;; esac
    sleep 0.1
  done
  tail -n 20 "$slurm_folder"/*.said >&2
  echo "Slurm has not come up: the node is ${state:-unknown}" >&2
  return 1
}

start_slurm() { # [jobs an array may have, and one]: exports SLURM_CONF
  # Munge wants folders that all may pass through and nobody else may write to.
  slurm_folder=$(mktemp -d "${TMPDIR:-/tmp}/glocal_slurm_XXXXXX")
  chmod 711 "$slurm_folder"
  mkdir "$slurm_folder/state" "$slurm_folder/spool"
  export SLURM_CONF=$slurm_folder/slurm.conf
  write_slurm_conf "${1:-1001}"
  start_munged
  start_slurmctld
  start_slurmd
  wait_for_slurm
}

# What systemd and an administrator do after a failure: daemons that have ended are started again; slurmctld drains a node that runs a job it does not know of,
# and holds jobs that it could not launch.
revive_slurm() {
  local job
  kill -0 "$slurmctld_pid" || start_slurmctld
  kill -0 "$slurmd_pid" || start_slurmd
  case $(sinfo -h -o %T) in drain* | down*) scontrol update NodeName=here State=RESUME ;; esac
  for job in $(squeue --noheader --array --states=PENDING --format='%i %r' | sed -n 's/ .*held.*//Ip'); do
    scontrol release "$job"
  done
} 2>/dev/null

stop_slurm() {
  [ -n "${slurm_folder:-}" ] || return 0
  # Daemons, jobs and what looks after them: all were given this environment, and nobody else.
  local environment pid
  for environment in /proc/[0-9]*/environ; do
    pid=${environment#/proc/}
    if grep -qzxF "SLURM_CONF=$SLURM_CONF" "$environment"; then kill -KILL "${pid%/environ}" || true; fi
  done
  wait "${slurmctld_pid:-}" "${slurmd_pid:-}" "${munged_pid:-}" || true
  rm -rf "$slurm_folder"
  slurm_folder=
} 2>/dev/null # the shell tells of each that was killed
