//! Controllers, as far as they matter here: commands that open a window, and the memory that pixels go to.
//!
//! Each follows its data sheet, and fails on pixels outside its memory.

use crate::bus::Panel;

/// A window of a memory with a cell for each unit that is written: where the next goes, row after row.
#[derive(Clone, Debug)]
struct Window {
    columns: [usize; 2],
    rows: [usize; 2],
    next: [usize; 2],
}

impl Window {
    fn new(width: usize, height: usize) -> Self {
        Self { columns: [0, width - 1], rows: [0, height - 1], next: [0, 0] }
    }

    fn restart(&mut self) {
        self.next = [self.columns[0], self.rows[0]];
    }

    /// Where this goes; after the last of the window comes its first.
    fn step(&mut self) -> [usize; 2] {
        let now = self.next;
        self.next[0] += 1;
        if now[0] == self.columns[1] {
            self.next = [self.columns[0], now[1] + 1];
            if now[1] == self.rows[1] {
                self.restart();
            }
        }
        now
    }
}

/// Two bytes, the high one first.
fn pair(bytes: &[u8]) -> usize {
    usize::from(bytes[0]) << 8 | usize::from(bytes[1])
}

/// A controller of 16-bit colours: the ST7789 and others of MIPI's command set, and the SSD1351.
pub(crate) struct Colors {
    width: usize,
    /// RGB565, row after row.
    pub(crate) memory: Vec<u16>,
    window: Window,
    /// The commands that set columns, set rows and begin pixels.
    commands: [u8; 3],
    /// Bytes of a coordinate.
    coordinate: usize,
    command: u8,
    parameters: Vec<u8>,
}

impl Colors {
    /// A ST7789's memory, of 240×320 pixels.
    pub(crate) fn st7789() -> Self {
        Self::new(240, 320, [0x2a, 0x2b, 0x2c], 2)
    }

    /// Of 128×128 pixels.
    pub(crate) fn ssd1351() -> Self {
        Self::new(128, 128, [0x15, 0x75, 0x5c], 1)
    }

    fn new(width: usize, height: usize, commands: [u8; 3], coordinate: usize) -> Self {
        let memory = vec![0x5555; width * height];
        let window = Window::new(width, height);
        Self { width, memory, window, commands, coordinate, command: 0, parameters: Vec::new() }
    }
}

impl Panel for Colors {
    fn command(&mut self, byte: u8) {
        self.command = byte;
        self.parameters.clear();
        if byte == self.commands[2] {
            self.window.restart();
        }
    }

    fn data(&mut self, byte: u8) {
        self.parameters.push(byte);
        let [columns, rows, pixels] = self.commands;
        if self.command == pixels && self.parameters.len() == 2 {
            let [x, y] = self.window.step();
            assert!(x < self.width, "{x}");
            self.memory[y * self.width + x] = pair(&self.parameters) as u16;
            self.parameters.clear();
        } else if self.parameters.len() == 2 * self.coordinate {
            let (start, end) = self.parameters.split_at(self.coordinate);
            let number = |bytes: &[u8]| bytes.iter().fold(0, |sum, &byte| sum << 8 | usize::from(byte));
            let ends = [number(start), number(end)];
            if self.command == columns {
                self.window.columns = ends;
            } else if self.command == rows {
                self.window.rows = ends;
            }
        }
    }
}

/// An SSD1306 of 128×64 pixels, in horizontal addressing.
pub(crate) struct Ssd1306 {
    /// By page of eight rows and column; the upper pixel is the least significant bit.
    memory: [[u8; 128]; 8],
    window: Window,
    is_horizontal: bool,
    command: Vec<u8>,
}

impl Ssd1306 {
    pub(crate) fn new() -> Self {
        let window = Window::new(128, 8);
        Self { memory: [[0x55; 128]; 8], window, is_horizontal: false, command: Vec::new() }
    }

    /// Row after row.
    pub(crate) fn shown(&self) -> Vec<bool> {
        (0..64)
            .flat_map(|y| (0..128).map(move |x| (x, y)))
            .map(|(x, y)| self.memory[y / 8][x] >> (y % 8) & 1 != 0)
            .collect()
    }
}

impl Panel for Ssd1306 {
    /// Its parameters are commands, too.
    fn command(&mut self, byte: u8) {
        self.command.push(byte);
        let length = match self.command[0] {
            0x20 | 0x81 | 0x8d | 0xa8 | 0xd3 | 0xd5 | 0xd9 | 0xda | 0xdb => 2,
            0x21 | 0x22 => 3,
            _ => 1,
        };
        if self.command.len() < length {
            return;
        }
        let numbers: Vec<_> = self.command.drain(..).map(usize::from).collect();
        match *numbers {
            [0x20, mode] => self.is_horizontal = mode == 0,
            [0x21, start, end] => self.window.columns = [start, end],
            [0x22, start, end] => self.window.rows = [start, end],
            _ => return,
        }
        self.window.restart();
    }

    fn data(&mut self, byte: u8) {
        assert!(self.is_horizontal);
        let [x, page] = self.window.step();
        self.memory[page][x] = byte;
    }
}

/// E-paper: rows of bits in bytes, the left pixel in the most significant, set for white.
pub(crate) struct Paper {
    /// Bytes of a row.
    stride: usize,
    memory: Vec<u8>,
    window: Window,
    controller: Controller,
    command: u8,
    parameters: Vec<u8>,
    /// Refreshed from its memory, as it was then.
    pub(crate) shown: Vec<bool>,
}

/// How a window is set.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Controller {
    /// First and last column and row, then where to begin.
    Ssd1680,
    /// In one command, in and out of partial mode by others.
    Il0398,
}

impl Paper {
    /// Of 128×296 pixels, as WeAct's of 2.9 inches.
    pub(crate) fn ssd1680() -> Self {
        Self::new(128, 296, Controller::Ssd1680)
    }

    /// Of 400×300 pixels, as Waveshare's of 4.2 inches.
    pub(crate) fn il0398() -> Self {
        Self::new(400, 300, Controller::Il0398)
    }

    fn new(width: usize, height: usize, controller: Controller) -> Self {
        let stride = width / 8;
        Self {
            stride,
            memory: vec![0x55; stride * height],
            window: Window::new(stride, height),
            controller,
            command: 0,
            parameters: Vec::new(),
            shown: Vec::new(),
        }
    }

    /// How many bytes wide and rows high the window is that was set last.
    pub(crate) fn window(&self) -> [usize; 2] {
        [self.window.columns, self.window.rows].map(|[start, end]| end - start + 1)
    }

    fn refresh(&mut self) {
        let bits = |byte: &u8| (0..8).rev().map(|bit| byte >> bit & 1 != 0).collect::<Vec<_>>();
        self.shown = self.memory.iter().flat_map(bits).collect();
    }
}

impl Panel for Paper {
    fn command(&mut self, byte: u8) {
        self.command = byte;
        self.parameters.clear();
        match (self.controller, byte) {
            (Controller::Ssd1680, 0x20) | (Controller::Il0398, 0x12) => self.refresh(),
            (Controller::Il0398, 0x13) => self.window.restart(),
            (Controller::Il0398, 0x92) => {
                self.window = Window::new(self.stride, self.memory.len() / self.stride)
            }
            _ => {}
        }
    }

    fn data(&mut self, byte: u8) {
        let little = |bytes: &[u8]| usize::from(bytes[1]) << 8 | usize::from(bytes[0]);
        self.parameters.push(byte);
        match (self.controller, self.command, &*self.parameters) {
            (Controller::Ssd1680, 0x24, _) | (Controller::Il0398, 0x13, _) => {
                let [x, y] = self.window.step();
                assert!(x < self.stride, "{x}");
                self.memory[y * self.stride + x] = byte;
                self.parameters.clear();
            }
            (Controller::Ssd1680, 0x44, &[start, end]) => self.window.columns = [start.into(), end.into()],
            (Controller::Ssd1680, 0x45, [start @ .., _, _]) if start.len() == 2 => {
                self.window.rows = [little(start), little(&self.parameters[2..])];
            }
            (Controller::Ssd1680, 0x4e, &[start]) => self.window.next[0] = start.into(),
            (Controller::Ssd1680, 0x4f, start @ [_, _]) => self.window.next[1] = little(start),
            // The last of nine parameters is whether gates outside of the window are scanned, too.
            (Controller::Il0398, 0x90, ends) if ends.len() == 8 => {
                self.window.columns = [pair(&ends[..2]) / 8, pair(&ends[2..4]) / 8];
                self.window.rows = [pair(&ends[4..6]), pair(&ends[6..])];
            }
            _ => {}
        }
    }
}
