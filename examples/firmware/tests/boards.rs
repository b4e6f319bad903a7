//! The boards against the desktop: the programs run under `qemu-system-arm`, and have to print the
//! checksums and to leave the picture that this machine computes.
//!
//! Needs QEMU and rustup's targets thumbv6m-none-eabi and thumbv7m-none-eabi, and fails without;
//! `FIXEL_SKIP_BOARDS=1` skips it.

use std::{
    env, fs,
    io::{BufRead, BufReader, Read, Write},
    net::{TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, ExitStatus, Stdio},
    sync::mpsc::{self, Receiver},
    thread,
    time::{Duration, Instant},
};

use embedded_graphics::{
    framebuffer::{Framebuffer, buffer_size},
    image::GetPixel,
    pixelcolor::{
        Gray4,
        raw::{BigEndian, RawU4},
    },
    prelude::*,
};
use fixel_firmware::{
    checksum::Gray4Sum,
    scene::{BAND_ROWS, FRAMES, MICROBIT, OLED, Scene},
};

/// A run takes a second; a hang must fail before anyone loses patience.
const TIMEOUT: Duration = Duration::from_secs(120);

struct Board {
    /// QEMU's name of it.
    machine: &'static str,
    /// The program that is made for it.
    program: &'static str,
    target: &'static str,
    /// Bytes of RAM from 0x2000_0000.
    ram: usize,
}

const LM3S6965EVB: Board =
    Board { machine: "lm3s6965evb", program: "oled", target: "thumbv7m-none-eabi", ram: 64 << 10 };

const MICROBIT_BOARD: Board =
    Board { machine: "microbit", program: "microbit", target: "thumbv6m-none-eabi", ram: 16 << 10 };

/// Where the pictures are left for a look.
fn scratch() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR"))
}

/// True when the boards are to be left out, which is said past the test harness's capture.
fn skipped() -> bool {
    let skipped = env::var_os("FIXEL_SKIP_BOARDS").is_some_and(|value| value == "1");
    if skipped {
        let _ =
            writeln!(std::io::stderr(), "\nSKIPPED: the emulated boards were not run (FIXEL_SKIP_BOARDS=1)");
    }
    skipped
}

impl Board {
    /// Compiles the program, in a target directory of its own: the outer cargo may hold the lock of its.
    fn build(&self) -> PathBuf {
        let directory = scratch().join("boards");
        let mut cargo = Command::new(env!("CARGO"));
        cargo
            .args(["build", "--release", "--locked", "--bin", self.program, "--target", self.target])
            .args(["--manifest-path", concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml")])
            .arg("--target-dir")
            .arg(&directory);

        let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
        let sysroot = Command::new(rustc).args(["--print", "sysroot"]).output();
        let sysroot = sysroot.expect("rustc runs").stdout;
        let rustlib = Path::new(String::from_utf8_lossy(&sysroot).trim()).join("lib/rustlib");
        if !rustlib.join(self.target).join("lib").exists() {
            // Where rustup cannot add the target, `core` may still be there as source.
            assert!(
                rustlib.join("src/rust/library/core").exists(),
                "this machine cannot build for {0}: run `rustup target add {0}`, \
                 or skip the boards by FIXEL_SKIP_BOARDS=1",
                self.target
            );
            cargo.env("RUSTC_BOOTSTRAP", "1").env("CARGO_UNSTABLE_BUILD_STD", "core");
        }

        let output = cargo.output().expect("cargo runs");
        assert!(
            output.status.success(),
            "{} does not build for {}:\n{}",
            self.program,
            self.target,
            String::from_utf8_lossy(&output.stderr)
        );
        directory.join(self.target).join("release").join(self.program)
    }

    fn start(&self, argument: Option<&str>) -> Emulator {
        Emulator::start(self, &self.build(), argument)
    }

    /// Lets the program end by itself and returns the lines that it printed.
    fn run(&self) -> Vec<String> {
        let mut emulator = self.start(None);
        let lines = emulator.read_until_end();
        let status = emulator.wait();
        assert!(status.success(), "{} ends with {status}:\n{}", self.program, lines.join("\n"));
        lines
    }

    /// Bytes of stack that a run has touched, of those that there are, from the runtime's stack painting.
    fn stack(&self, emulator: &mut Emulator) -> (usize, usize) {
        let file = format!("{}.ram", self.program);
        emulator.execute(&format!(
            r#"{{"execute":"memsave","arguments":{{"val":536870912,"size":{},"filename":"{file}"}}}}"#,
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
struct Emulator {
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
    fn read_line(&mut self) -> Option<String> {
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
    fn execute(&mut self, command: &str) {
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

/// A picture in memory in the display's own format.
type Picture = Framebuffer<
    Gray4,
    RawU4,
    BigEndian,
    { OLED.width as usize },
    { OLED.height as usize },
    { buffer_size::<Gray4>(OLED.width as usize, OLED.height as usize) },
>;

/// The lines of the `oled` program and its last picture, as this machine computes them.
fn expected_oled() -> (Vec<String>, Picture) {
    let scene = Scene::new(OLED);
    let count = OLED.width as usize * BAND_ROWS;
    let (mut pixels, mut depth) = (vec![0; count], vec![0; count]);
    let mut picture = Picture::new();
    let lines = (0..FRAMES)
        .map(|frame| {
            let Ok((rgb565, gray4)) = scene.show(frame, &mut pixels, &mut depth, &mut picture);
            let mut sum = Gray4Sum::new();
            sum.add(picture.bounding_box().points().map(|point| picture.pixel(point).expect("it is inside")));
            assert_eq!(sum.finish(), gray4, "the checksum is that of what was drawn");
            format!("frame {frame} rgb565 {rgb565:08X} gray4 {gray4:08X}")
        })
        .collect();
    (lines, picture)
}

/// Width, height and RGB bytes of a binary PPM with one space or line feed between its numbers.
fn read_ppm(path: &Path) -> (u32, u32, Vec<u8>) {
    let mut file = BufReader::new(fs::File::open(path).expect("QEMU wrote the picture"));
    let mut header = Vec::<u8>::new();
    while header.iter().filter(|byte| byte.is_ascii_whitespace()).count() < 4 {
        let mut byte = [0];
        file.read_exact(&mut byte).expect("the header is whole");
        header.push(byte[0]);
    }
    let header = String::from_utf8(header).expect("the header is text");
    let fields = header.split_ascii_whitespace().collect::<Vec<_>>();
    let ["P6", width, height, "255"] = *fields else { panic!("not a PPM of 8 bits: {header:?}") };
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).expect("the picture is whole");
    (width.parse().expect("a number"), height.parse().expect("a number"), bytes)
}

#[test]
fn the_oled_program_prints_the_desktops_checksums() {
    if skipped() {
        return;
    }
    assert_eq!(LM3S6965EVB.run(), expected_oled().0);
}

#[test]
fn the_oled_shows_the_desktops_picture() {
    if skipped() {
        return;
    }
    let (lines, expected) = expected_oled();
    let mut emulator = LM3S6965EVB.start(Some("hold"));
    for line in lines {
        assert_eq!(emulator.read_line(), Some(line));
    }
    // The program prints a frame after its last byte is in the display's memory, then waits for ever.
    emulator.execute(r#"{"execute":"screendump","arguments":{"filename":"oled.ppm"}}"#);
    let (used, size) = LM3S6965EVB.stack(&mut emulator);
    println!("oled: {used} bytes of a stack of {size} used");
    assert!(used + 1024 <= size);

    // QEMU draws each pixel as a square of 4×4, and level n as the grey 17·n.
    const MAGNIFY: u32 = 4;
    let path = scratch().join("oled.ppm");
    let (width, height, shown) = read_ppm(&path);
    assert_eq!((width, height), (OLED.width * MAGNIFY, OLED.height * MAGNIFY));
    assert_eq!(shown.len(), (width * height * 3) as usize);
    for (i, rgb) in (0..).zip(shown.chunks_exact(3)) {
        let (x, y) = (i % width / MAGNIFY, i / width / MAGNIFY);
        let level = expected.pixel(Point::new(x as i32, y as i32)).expect("it is inside");
        assert_eq!(rgb, [level.luma() * 17; 3], "pixel ({x}, {y}) of {}", path.display());
    }
    println!("{} shows the picture", path.display());
}

#[test]
fn the_microbit_program_prints_the_desktops_checksums() {
    if skipped() {
        return;
    }
    let scene = Scene::new(MICROBIT);
    // The whole frame at once, where the board draws strips.
    let count = (MICROBIT.width * MICROBIT.height) as usize;
    let (mut pixels, mut depth) = (vec![0; count], vec![0; count]);
    let expected = (0..FRAMES)
        .map(|frame| {
            let Ok(rgb565) =
                scene.frame(frame, &mut pixels, &mut depth, |_| Ok::<_, core::convert::Infallible>(()));
            format!("frame {frame} rgb565 {rgb565:08X}")
        })
        .collect::<Vec<_>>();
    assert_eq!(MICROBIT_BOARD.run(), expected);

    let mut emulator = MICROBIT_BOARD.start(Some("hold"));
    for line in expected {
        assert_eq!(emulator.read_line(), Some(line));
    }
    let (used, size) = MICROBIT_BOARD.stack(&mut emulator);
    println!("microbit: {used} bytes of a stack of {size} used");
    assert!(used + 1024 <= size);
}
