//! A child and all its children: started in a process group of their own, ended together, and never left behind.

use std::io;
use std::process::{Child, ExitStatus};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::watchdog;

/// Between looks at whether a process is gone.
const LOOK: Duration = Duration::from_millis(5);

/// Numbers and marks of the children that were started and not yet reaped: so long they cannot belong to anybody else.
static RUNNING: Mutex<Vec<(u32, String)>> = Mutex::new(Vec::new());

/// Starts `command` in a process group of its own: Ctrl-C on the terminal is for hairpin, which ends its executors in
/// order, and a shell's or launcher's children can be ended with it.
pub(crate) fn start(command: &mut std::process::Command) -> io::Result<Child> {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    let mark = watchdog::mark(command);
    let mut running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
    let child = command.spawn()?;
    watchdog::tell(child.id(), true);
    running.push((child.id(), mark));
    Ok(child)
}

/// Kills every running program with all its children and waits for none: for a process that is about to exit.
pub fn kill_all() {
    #[cfg(unix)]
    for (number, mark) in RUNNING.lock().unwrap_or_else(PoisonError::into_inner).iter() {
        use rustix::process::{Pid, Signal, kill_process_group};
        let group = i32::try_from(*number).ok().and_then(Pid::from_raw);
        // It fails only where the whole group is gone already.
        let _ = group.map(|group| kill_process_group(group, Signal::KILL));
        watchdog::kill_strays(mark);
    }
}

/// Waits at most `patience` for the child to exit by itself, asks the group to terminate, waits at most `grace`, kills
/// what is left of the group, and of what has left the group. The exit status is that of the child.
pub(crate) fn end(child: &mut Child, patience: Duration, grace: Duration) -> Option<ExitStatus> {
    if !exits_within(child, patience) {
        signal(child, Ending::Terminate);
        exits_within(child, grace);
    }
    // Before the child is reaped: until then its number cannot belong to anybody else.
    signal(child, Ending::Kill);
    let mut running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
    let place = running.iter().position(|(number, _)| *number == child.id());
    let mark = place.map(|place| running.swap_remove(place).1);
    drop(running);
    watchdog::tell(child.id(), false);
    mark.iter().for_each(|mark| watchdog::kill_strays(mark));
    child.wait().ok()
}

/// Whether the child exits in time. It is not reaped, so that its group can still be named.
pub(super) fn exits_within(child: &mut Child, patience: Duration) -> bool {
    let deadline = Instant::now() + patience;
    loop {
        if has_exited(child) {
            return true;
        }
        if Instant::now() >= deadline {
            return false;
        }
        std::thread::sleep(LOOK);
    }
}

enum Ending {
    Terminate,
    Kill,
}

#[cfg(unix)]
fn has_exited(child: &mut Child) -> bool {
    use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
    !matches!(waitid(WaitId::Pid(Pid::from_child(child)), options), Ok(None))
}

#[cfg(unix)]
fn signal(child: &mut Child, ending: Ending) {
    use rustix::process::{Pid, Signal, kill_process_group};
    let signal = match ending {
        Ending::Terminate => Signal::TERM,
        Ending::Kill => Signal::KILL,
    };
    // It fails only where the whole group is gone already, which is what is wanted.
    let _ = kill_process_group(Pid::from_child(child), signal);
}

#[cfg(not(unix))]
fn has_exited(child: &mut Child) -> bool {
    !matches!(child.try_wait(), Ok(None))
}

#[cfg(not(unix))]
fn signal(child: &mut Child, ending: Ending) {
    match ending {
        Ending::Terminate => {}
        Ending::Kill => {
            let _ = child.kill();
        }
    }
}
