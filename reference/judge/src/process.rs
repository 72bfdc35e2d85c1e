//! A judged program: it reads standard input and writes standard output. The judge lets it compute
//! no longer than the time limit, and reads no more than the longest correct answer. It has one
//! process per case, or, as a [`Service`], processes that answer one case after the other.

use std::io::{Read, Write};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::answer::{Answer, AnswerError, Seconds, StopReason};
use super::case::Case;
use super::subject::Subject;
use super::wire::{Wire, beginning, book};

/// A program and how it is run.
#[derive(Clone, Debug)]
pub struct Program {
    /// A line for the system's shell.
    pub command: String,
    /// How cases are written for it.
    pub wire: Wire,
    /// How long a program may compute for a case, in addition to a second per megabyte of it. On
    /// Linux its processor time counts, so that other work on the machine is not held against it.
    pub timeout: Duration,
}

/// How many time limits a program may take that has not computed for one.
const PATIENCE: u32 = 10;
/// How much is read at a time.
const CHUNK: usize = 1 << 16;
/// Bytes of standard error that are kept.
const SAID: usize = 400;
/// Bytes that a program may write in addition to its pairs.
const CHATTER: usize = 1 << 16;

impl Program {
    /// The case as the program reads it.
    fn input(&self, case: &Case) -> Result<Vec<u8>, AnswerError> {
        let start = |e: serde_json::Error| AnswerError::Start { why: e.to_string() };
        self.wire.encode(case).map_err(start)
    }

    fn start(&self) -> Result<RunningProgram, AnswerError> {
        let start = |e: std::io::Error| AnswerError::Start { why: e.to_string() };
        RunningProgram::start(&self.command).map_err(start)
    }

    /// The time that a program has for a case of this many bytes.
    fn time(&self, bytes: usize) -> Duration {
        self.timeout + Duration::from_micros(bytes as u64)
    }
}

impl Subject for Program {
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        let input = self.input(case)?;
        let (mut running, time) = (self.start()?, self.time(input.len()));
        running.feed(input);
        running.end_input();
        running.answers(self.wire, case, time)
    }
}

/// A program whose processes outlive a case: the next header follows on the last frame. As many run
/// as cases are judged at once. A process that fails, or has not answered every frame, is ended and
/// replaced, so that a case's end is never taken for the next one's beginning.
pub struct Service {
    program: Program,
    idle: Mutex<Vec<RunningProgram>>,
}

impl Service {
    /// A service of a program that reads further headers.
    #[must_use]
    pub fn new(program: Program) -> Self {
        let idle = Mutex::new(Vec::new());
        Self { program, idle }
    }

    fn idle(&self) -> std::sync::MutexGuard<'_, Vec<RunningProgram>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Subject for Service {
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        let input = self.program.input(case)?;
        let time = self.program.time(input.len());
        let idle = self.idle().pop();
        let mut running = idle.map_or_else(|| self.program.start(), Ok)?;
        running.feed(input);
        let answered = running.answers(self.program.wire, case, time);
        let is_in_step = matches!(answered, Ok(_) | Err(StopReason::Skipped { .. }));
        if is_in_step && running.buffer.is_empty() {
            self.idle().push(running);
        }
        answered
    }
}

/// A process with threads that feed and read it. Dropping it ends it and all that it has started.
struct RunningProgram {
    child: Child,
    input: Option<Sender<Vec<u8>>>,
    output: Receiver<Vec<u8>>,
    said: Receiver<String>,
    buffer: Vec<u8>,
    bytes: usize,
}

impl RunningProgram {
    fn start(command: &str) -> std::io::Result<Self> {
        let mut child = shell(command)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()?;
        let (send, output) = sync_channel(4);
        let ((say, said), (feed, fed)) = (channel(), channel::<Vec<u8>>());
        if let Some(mut stdin) = child.stdin.take() {
            // A program need not read to the end; its answers are judged.
            thread::spawn(move || fed.iter().try_for_each(|case| stdin.write_all(&case)));
        }
        if let Some(mut stdout) = child.stdout.take() {
            thread::spawn(move || {
                let mut chunk = vec![0; CHUNK];
                while let Ok(n @ 1..) = stdout.read(&mut chunk) {
                    if send.send(chunk[..n].to_vec()).is_err() {
                        break;
                    }
                }
            });
        }
        if let Some(mut stderr) = child.stderr.take() {
            thread::spawn(move || say.send(tail(&mut stderr)));
        }
        Ok(Self { child, input: Some(feed), output, said, buffer: Vec::new(), bytes: 0 })
    }

    /// Has a case written to its input.
    fn feed(&mut self, case: Vec<u8>) {
        if let Some(input) = &self.input {
            let _ = input.send(case); // one that has ended is found when it is read
        }
    }

    fn end_input(&mut self) {
        self.input = None;
    }

    /// The answers to the case that was fed; unless other cases may follow, the process has to end
    /// after them.
    fn answers(
        &mut self,
        wire: Wire,
        case: &Case,
        time: Duration,
    ) -> Result<Vec<Answer>, StopReason> {
        let goes_on = self.input.is_some();
        self.bytes = 0;
        let mut clock = CaseClock::new(self.child.id(), time);
        let limit = Seconds(time.as_secs_f64());
        let (frames, most) = (case.frames.len(), most_bytes(case));
        let mut answers = Vec::new();
        loop {
            if goes_on && answers.len() == frames && self.buffer.is_empty() {
                return Ok(answers);
            }
            let line = match self.line(&mut clock, most) {
                Ok(Some(line)) => line,
                Ok(None) => break,
                Err(LineError::Flood) => return Err(AnswerError::Flood { bytes: most }.into()),
                Err(LineError::Late) if answers.len() == frames => {
                    return Err(AnswerError::Hanging { seconds: clock.waited() }.into());
                }
                Err(LineError::Late) => {
                    let (frame, seconds) = (answers.len(), clock.waited());
                    return Err(match seconds.0 < (PATIENCE * time).as_secs_f64() {
                        true => AnswerError::Timeout { frame, seconds: limit },
                        false => AnswerError::Idle { frame, seconds },
                    }
                    .into());
                }
            };
            if line.trim_ascii().is_empty() {
                continue;
            }
            if answers.len() == frames {
                let line = beginning(&line);
                return Err(AnswerError::TooMany { frames, line }.into());
            }
            let said = wire.decode(answers.len(), &line)?;
            book(&mut answers, said, &line)?;
        }
        let answered = answers.len();
        let Some(status) = self.status(&mut clock) else {
            return Err(AnswerError::Hanging { seconds: clock.waited() }.into());
        };
        if !status.success() {
            let (how, said) = (ending(status), self.said());
            // What the shell says of a command that it can't execute or find.
            if answered == 0 && matches!(status.code(), Some(126 | 127)) {
                let why = format!("{how}{said}");
                return Err(AnswerError::Start { why }.into());
            }
            return Err(AnswerError::Crashed { how, answered, said }.into());
        }
        if answered < frames {
            let said = self.said();
            return Err(AnswerError::Early { answered, frames, said }.into());
        }
        Ok(answers)
    }

    /// The next line; `None` at the end of the output.
    fn line(&mut self, clock: &mut CaseClock, most: usize) -> Result<Option<Vec<u8>>, LineError> {
        let mut searched = 0;
        loop {
            if let Some(end) = self.buffer[searched..].iter().position(|byte| *byte == b'\n') {
                let rest = self.buffer.split_off(searched + end + 1);
                return Ok(Some(std::mem::replace(&mut self.buffer, rest)));
            }
            searched = self.buffer.len();
            let left = clock.deadline.saturating_duration_since(Instant::now());
            match self.output.recv_timeout(left) {
                Ok(chunk) => self.buffer.extend(chunk),
                Err(RecvTimeoutError::Timeout) if clock.goes_on() => {}
                Err(RecvTimeoutError::Timeout) => return Err(LineError::Late),
                Err(RecvTimeoutError::Disconnected) if self.buffer.is_empty() => return Ok(None),
                Err(RecvTimeoutError::Disconnected) => {
                    return Ok(Some(std::mem::take(&mut self.buffer)));
                }
            }
            self.bytes += self.buffer.len() - searched;
            if self.bytes > most {
                return Err(LineError::Flood);
            }
        }
    }

    fn status(&mut self, clock: &mut CaseClock) -> Option<ExitStatus> {
        loop {
            match self.child.try_wait() {
                Ok(Some(status)) => return Some(status),
                Ok(None) if Instant::now() < clock.deadline || clock.goes_on() => {
                    thread::sleep(Duration::from_millis(1));
                }
                _ => return None,
            }
        }
    }

    /// The end of what it wrote to standard error.
    fn said(&self) -> String {
        match self.said.recv_timeout(Duration::from_millis(200)) {
            Ok(said) if !said.is_empty() => format!("; it says: {said}"),
            _ => String::new(),
        }
    }
}

impl Drop for RunningProgram {
    fn drop(&mut self) {
        // The group first: the shell's children are in it. It is this process's own, so it can't be
        // another's.
        #[cfg(unix)]
        if let Some(group) = rustix::process::Pid::from_raw(self.child.id() as i32) {
            let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// When a process has had its time for a case.
struct CaseClock {
    group: u32,
    limit: Duration,
    start: Instant,
    /// What the process had computed before.
    computed: Option<Duration>,
    deadline: Instant,
}

impl CaseClock {
    fn new(group: u32, limit: Duration) -> Self {
        let (start, computed) = (Instant::now(), processor_time(group));
        Self { group, limit, start, computed, deadline: start + limit }
    }

    fn waited(&self) -> Seconds {
        Seconds(self.start.elapsed().as_secs_f64())
    }

    /// At the deadline, whether there is a later one: the process has not computed for as long as
    /// it may.
    fn goes_on(&mut self) -> bool {
        let computed = processor_time(self.group).zip(self.computed);
        let Some(computed) = computed.map(|(now, before)| now.saturating_sub(before)) else {
            return false;
        };
        let waited = self.start.elapsed();
        let left = self.limit.saturating_sub(computed);
        let left = left.min((PATIENCE * self.limit).saturating_sub(waited));
        self.deadline = Instant::now() + left;
        !left.is_zero()
    }
}

/// The processor time that a group of processes has used, of which those that have ended count if
/// another of the group has waited for them. `None` where the system doesn't say it.
#[cfg(target_os = "linux")]
fn processor_time(group: u32) -> Option<Duration> {
    const TICKS_PER_SECOND: u64 = 100; // of Linux, on all processors
    let group = group.to_string();
    let mut ticks = None;
    for entry in std::fs::read_dir("/proc").ok()?.flatten() {
        // Its name, in brackets, may hold anything; numbers follow.
        let stat = std::fs::read_to_string(entry.path().join("stat")).unwrap_or_default();
        let fields: Vec<&str> =
            stat.rsplit_once(')').map_or("", |(_, rest)| rest).split_whitespace().collect();
        if fields.get(2) == Some(&group.as_str()) {
            let used = fields.iter().skip(11).take(4).filter_map(|field| field.parse::<u64>().ok());
            ticks = Some(ticks.unwrap_or(0) + used.sum::<u64>());
        }
    }
    Some(Duration::from_millis(ticks? * 1000 / TICKS_PER_SECOND))
}

#[cfg(not(target_os = "linux"))]
fn processor_time(_: u32) -> Option<Duration> {
    None
}

/// Why no line was read.
enum LineError {
    Late,
    Flood,
}

#[cfg(unix)]
fn shell(command: &str) -> Command {
    use std::os::unix::process::CommandExt as _;
    let mut shell = Command::new("sh");
    shell.arg("-c").arg(command).process_group(0);
    shell
}

#[cfg(not(unix))]
fn shell(command: &str) -> Command {
    let mut shell = Command::new("cmd");
    shell.arg("/C").arg(command);
    shell
}

/// More bytes than any correct answer to a case: 24 bytes hold a pair.
fn most_bytes(case: &Case) -> usize {
    let pairs = |n: usize| n * n.saturating_sub(1) / 2;
    let frames = case.frames.iter().map(|frame| 256 + 24 * pairs(frame.bodies.len()));
    CHATTER + frames.sum::<usize>()
}

/// The last bytes of a stream, on one line.
fn tail(stream: &mut impl Read) -> String {
    let (mut kept, mut chunk) = (Vec::new(), [0; 4096]);
    while let Ok(n @ 1..) = stream.read(&mut chunk) {
        kept.extend_from_slice(&chunk[..n]);
        let surplus = kept.len().saturating_sub(SAID);
        kept.drain(..surplus);
    }
    let text = String::from_utf8_lossy(&kept);
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn ending(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return format!("signal {signal}");
    }
    status.code().map_or_else(|| status.to_string(), |code| format!("exit code {code}"))
}
