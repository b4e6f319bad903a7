//! Programs on boards that QEMU emulates: built, run, and looked into.

use std::{
    env, fs,
    io::{BufRead, BufReader, Write},
    net::{TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, ExitStatus, Stdio},
    sync::mpsc::{self, Receiver},
    thread,
    time::{Duration, Instant},
};

use object::{Object, ObjectSection, ObjectSymbol};

use super::cargo;

/// A run takes a second; a hang must fail before anyone loses patience.
const TIMEOUT: Duration = Duration::from_secs(120);

/// Where a Cortex-M has its RAM.
const RAM_START: usize = 0x2000_0000;

pub(super) struct Board {
    /// QEMU's name of it.
    pub(super) machine: &'static str,
    /// What else QEMU is told.
    pub(super) options: &'static [&'static str],
    /// The program that is made for it.
    pub(super) program: &'static str,
    /// The package's features that the program needs.
    pub(super) features: &'static str,
    pub(super) target: &'static str,
    /// Bytes of RAM from [`RAM_START`].
    pub(super) ram: usize,
}

/// Where the pictures are left for a look.
pub(super) fn scratch() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR"))
}

/// True when the boards are to be left out, which is said past the test harness's capture.
pub(super) fn skipped() -> bool {
    let skipped = env::var_os("FIXEL_SKIP_BOARDS").is_some_and(|value| value == "1");
    if skipped {
        let _ =
            writeln!(std::io::stderr(), "\nSKIPPED: the emulated boards were not run (FIXEL_SKIP_BOARDS=1)");
    }
    skipped
}

impl Board {
    fn build(&self) -> PathBuf {
        cargo::build(&[self.program], self.features, self.target, "").join(self.program)
    }

    /// The program's variables in RAM by their names, with their bytes, as the linker placed them; and the bytes from the
    /// first to the last, which with the stack is all the RAM that it uses.
    pub(super) fn statics(&self) -> (Vec<(String, u64)>, u64) {
        let elf = fs::read(self.build()).expect("the program was built");
        let elf = object::File::parse(&*elf).expect("it is an ELF file");
        let start = RAM_START as u64;
        let is_ram = |address: u64| (start..start + self.ram as u64).contains(&address);
        let variables = elf
            .symbols()
            .filter(|symbol| symbol.size() > 0 && is_ram(symbol.address()))
            .map(|symbol| {
                let name = symbol.name().expect("it is text");
                (format!("{:#}", rustc_demangle::demangle(name)), symbol.size())
            })
            .collect();
        let end = elf
            .sections()
            .filter(|section| section.size() > 0 && is_ram(section.address()))
            .map(|section| section.address() + section.size())
            .max();
        (variables, end.unwrap_or(start) - start)
    }

    pub(super) fn start(&self, argument: Option<&str>) -> Emulator {
        Emulator::start(self, &self.build(), argument)
    }

    /// Lets the program end by itself and returns the lines that it printed.
    pub(super) fn run(&self) -> Vec<String> {
        let mut emulator = self.start(None);
        let lines = emulator.read_until_end();
        let status = emulator.wait();
        assert!(status.success(), "{} ends with {status}:\n{}", self.program, lines.join("\n"));
        lines
    }

    /// Bytes of stack that a run has touched, of those that there are, from the runtime's stack painting.
    pub(super) fn stack(&self, emulator: &mut Emulator) -> (usize, usize) {
        let file = format!("{}.ram", self.program);
        emulator.execute(&format!(
            r#"{{"execute":"memsave","arguments":{{"val":{RAM_START},"size":{},"filename":"{file}"}}}}"#,
            self.ram
        ));
        let ram = fs::read(scratch().join(file)).expect("QEMU wrote the RAM");
        assert_eq!(ram.len(), self.ram);
        let is_paint = |word: &[u8]| word == [0xCC; 4];
        let words = ram.chunks_exact(4).collect::<Vec<_>>();
        // The longest painted run is the rest of the stack: statics below, what was used above.
        let run = words
            .chunk_by(|a, b| is_paint(a) == is_paint(b))
            .scan(0, |end, run| {
                *end += run.len();
                Some((run.len() * usize::from(is_paint(run[0])), *end))
            })
            .max()
            .expect("there is RAM");
        let used = self.ram - run.1 * 4;
        (used, used + run.0 * 4)
    }
}

/// A running QEMU, killed when dropped.
pub(super) struct Emulator {
    child: Child,
    printed: Receiver<String>,
    monitor: BufReader<TcpStream>,
    deadline: Instant,
}

impl Emulator {
    fn start(board: &Board, program: &Path, argument: Option<&str>) -> Self {
        let deadline = Instant::now() + TIMEOUT;
        // QEMU calls back, so that no port has to be guessed.
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port is free");
        let port = listener.local_addr().expect("it is bound").port();
        let mut semihosting = format!("enable=on,target=native,chardev=printed,arg={}", board.program);
        if let Some(argument) = argument {
            semihosting += &format!(",arg={argument}");
        }
        let mut child = Command::new("qemu-system-arm")
            .args(["-machine", board.machine, "-display", "none"])
            .args(["-serial", "none", "-monitor", "none"])
            .args(board.options)
            .args(["-chardev", "stdio,id=printed,signal=off"])
            .args(["-semihosting-config", &semihosting])
            .args(["-qmp", &format!("tcp:127.0.0.1:{port}")])
            .arg("-kernel")
            .arg(program)
            .current_dir(scratch())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .unwrap_or_else(|error| {
                panic!(
                    "qemu-system-arm does not start ({error}): install it (Debian: qemu-system-arm, \
                     Homebrew: qemu), or skip the boards by FIXEL_SKIP_BOARDS=1"
                )
            });

        let (sender, printed) = mpsc::channel();
        let stdout = BufReader::new(child.stdout.take().expect("it is piped"));
        thread::spawn(move || stdout.lines().map_while(Result::ok).try_for_each(|line| sender.send(line)));

        let (sender, connection) = mpsc::channel();
        thread::spawn(move || sender.send(listener.accept()));
        let monitor = loop {
            if let Ok(accepted) = connection.recv_timeout(Duration::from_millis(20)) {
                break accepted.expect("the port is open").0;
            }
            let ended = child.try_wait().expect("it is a child");
            if ended.is_some() || Instant::now() > deadline {
                let _ = child.kill();
                panic!("QEMU did not open its monitor: {ended:?}");
            }
        };
        monitor.set_read_timeout(Some(TIMEOUT)).expect("the timeout is not zero");
        let mut emulator = Self { child, printed, monitor: BufReader::new(monitor), deadline };
        // The greeting needs no look: the answer to the first command comes after it.
        emulator.execute(r#"{"execute":"qmp_capabilities"}"#);
        emulator
    }

    /// The next line that the program prints, or `None` at its end.
    pub(super) fn read_line(&mut self) -> Option<String> {
        let left = self.deadline.saturating_duration_since(Instant::now());
        match self.printed.recv_timeout(left) {
            Ok(line) => Some(line),
            Err(mpsc::RecvTimeoutError::Disconnected) => None,
            Err(mpsc::RecvTimeoutError::Timeout) => panic!("the program hangs"),
        }
    }

    fn read_until_end(&mut self) -> Vec<String> {
        std::iter::from_fn(|| self.read_line()).collect()
    }

    fn wait(&mut self) -> ExitStatus {
        loop {
            if let Some(status) = self.child.try_wait().expect("it is a child") {
                return status;
            }
            assert!(Instant::now() < self.deadline, "QEMU does not end");
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// Has the monitor do a command to its end.
    pub(super) fn execute(&mut self, command: &str) {
        writeln!(self.monitor.get_mut(), "{command}").expect("the monitor listens");
        loop {
            let mut answer = String::new();
            let length = self.monitor.read_line(&mut answer).expect("the monitor answers in time");
            assert!(length > 0, "QEMU ended at {command}");
            assert!(!answer.starts_with(r#"{"error""#), "{command}: {answer}");
            if answer.starts_with(r#"{"return""#) {
                return;
            }
        }
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
