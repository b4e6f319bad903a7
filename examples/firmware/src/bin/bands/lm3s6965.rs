//! The program on the board: its RAM is these buffers and the stack.

use crate::frame::{self, PIXELS};
use fixel_firmware::s4::{List, Memory};
use semihosting::{experimental::env, println, process};

#[cortex_m_rt::entry]
fn main() -> ! {
    // `entry` hands these out as `&mut`: it runs once.
    static mut COLORS: [u16; PIXELS] = [0; PIXELS];
    static mut DEPTH: [u16; PIXELS] = [0; PIXELS];
    static mut MEMORY: Memory = Memory::new();
    static mut LIST: Option<List<'static>> = None;

    let arguments = env::args::<64>().expect("the command line fits");
    let hold = (&arguments).into_iter().any(|argument| argument == Ok("hold"));

    let list = LIST.insert(List::new(MEMORY));
    println!("s4 rgb565 {:08X}", frame::draw(COLORS, DEPTH, list));
    if hold {
        loop {
            cortex_m::asm::wfi();
        }
    }
    process::exit(0)
}
