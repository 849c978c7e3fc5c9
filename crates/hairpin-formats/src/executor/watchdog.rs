//! Nothing that hairpin starts outlives it, however it ends. A shell waits beside it, in a group of its own; it is told
//! which groups of processes run, and when hairpin is gone, be it by a kill, its pipe closes and it ends what is left.
//!
//! Who leaves his group (`setsid`) is found by a variable in his environment, where the system shows that (Linux). Who
//! leaves his group and clears his environment as well is not found.

use std::io::Write;
use std::process::{ChildStdin, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

/// The variable by which a child, and whatever it starts, is told from other processes.
const MARK: &str = "HAIRPIN_PROGRAM";
/// `+ GROUP` and `- GROUP` a line; then the end.
const WATCH: &str = include_str!("watchdog.sh");
/// Looks for children that leave their group while others are ended.
const LOOKS: usize = 3;

static WATCHDOG: OnceLock<Option<Mutex<ChildStdin>>> = OnceLock::new();
static TOKEN: OnceLock<String> = OnceLock::new();
static STARTED: AtomicU64 = AtomicU64::new(0);

/// Marks the child that `command` starts; gives its mark.
pub(super) fn mark(command: &mut Command) -> String {
    let value = format!("{}{}", token(), STARTED.fetch_add(1, Ordering::Relaxed));
    command.env(MARK, &value);
    format!("{MARK}={value}")
}

/// No other process that runs now or soon has the same.
fn token() -> &'static str {
    TOKEN.get_or_init(|| {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        format!("{}-{:x}.", std::process::id(), now.as_nanos())
    })
}

/// The group of a child runs, or does no longer.
pub(super) fn tell(group: u32, runs: bool) {
    let watchdog = WATCHDOG.get_or_init(|| begin().map(Mutex::new));
    if let Some(watchdog) = watchdog {
        let line = format!("{} {group}\n", if runs { '+' } else { '-' });
        // It fails only where somebody ended the watchdog.
        let _ = watchdog.lock().unwrap_or_else(PoisonError::into_inner).write_all(line.as_bytes());
    }
}

/// Starts it; `None` where there is no shell.
#[cfg(unix)]
fn begin() -> Option<ChildStdin> {
    let mut shell = Command::new("sh");
    shell.args(["-c", WATCH, "hairpin-watchdog"]).arg(format!("{MARK}={}", token())).env_remove(MARK).current_dir("/");
    shell.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
    std::os::unix::process::CommandExt::process_group(&mut shell, 0);
    shell.spawn().ok()?.stdin.take()
}

#[cfg(not(unix))]
fn begin() -> Option<ChildStdin> {
    None
}

/// Kills what a child with this `mark` started and what has left its group.
#[cfg(target_os = "linux")]
pub(super) fn kill_strays(mark: &str) {
    use rustix::process::{Pid, Signal, kill_process};
    for _ in 0..LOOKS {
        let strays: Vec<Pid> = strays(mark).into_iter().filter_map(Pid::from_raw).collect();
        if strays.is_empty() {
            return;
        }
        for stray in strays {
            // It fails only where it is gone already.
            let _ = kill_process(stray, Signal::KILL);
        }
    }
}

#[cfg(not(target_os = "linux"))]
pub(super) fn kill_strays(_: &str) {}

/// Numbers of the processes whose environment has `mark`.
#[cfg(target_os = "linux")]
fn strays(mark: &str) -> Vec<i32> {
    let processes = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let numbers = processes.filter_map(|entry| entry.file_name().to_str()?.parse::<i32>().ok());
    let marked = |number: &i32| {
        let environment = std::fs::read(format!("/proc/{number}/environ")).unwrap_or_default();
        environment.split(|byte| *byte == 0).any(|variable| variable == mark.as_bytes())
    };
    numbers.filter(marked).collect()
}
