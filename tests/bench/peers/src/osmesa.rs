//! llvmpipe, Mesa's software renderer, through the C library `libOSMesa`, which is loaded when the program runs: OpenGL
//! 3.3 with vertex buffers and GLSL. Debian and its kin have it in the package `libosmesa6`.
//!
//! It draws into a framebuffer object; the library would copy its own framebuffer once more after each frame.

#![allow(unsafe_code, reason = "calls a C library; the one place where that is allowed")]

use std::ffi::{CStr, CString, c_char, c_int, c_uint, c_void};
use std::mem::transmute_copy;
use std::ptr::{null, null_mut};

use libloading::Library;

use crate::ours::Frame;
use crate::scenes::{AMBIENT, Scene, TEXTURE_SIDE, TO_LIGHT, Vertex, texels};

/// The names under which the library may be found.
const LIBRARIES: [&str; 3] = ["libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"];
/// What to do if it is not.
const HOW_TO_GET: &str = "libOSMesa.so.8 is missing; on Debian and its kin: apt install libosmesa6";

type Enum = c_uint;
type Context = *mut c_void;

/// What a `c_int` attribute list of a context says: OpenGL 3.3, core profile, no buffers of the library's own but color.
const CONTEXT: [c_int; 11] = [0x22, 0x1908, 0x30, 0, 0x33, 0x34, 0x36, 3, 0x37, 3, 0];

const ARRAY_BUFFER: Enum = 0x8892;
const BACK: Enum = 0x0405;
const BGRA: Enum = 0x80E1;
const COLOR_ATTACHMENT0: Enum = 0x8CE0;
const COLOR_BUFFER_BIT: c_uint = 0x4000;
const COMPILE_STATUS: Enum = 0x8B81;
const CULL_FACE: Enum = 0x0B44;
const DEPTH_ATTACHMENT: Enum = 0x8D00;
const DEPTH_BUFFER_BIT: c_uint = 0x0100;
const DEPTH_COMPONENT24: Enum = 0x81A6;
const DEPTH_TEST: Enum = 0x0B71;
const ELEMENT_ARRAY_BUFFER: Enum = 0x8893;
const FLOAT: Enum = 0x1406;
const FRAGMENT_SHADER: Enum = 0x8B30;
const FRAMEBUFFER: Enum = 0x8D40;
const FRAMEBUFFER_COMPLETE: Enum = 0x8CD5;
const LEQUAL: Enum = 0x0203;
const LINK_STATUS: Enum = 0x8B82;
const NEAREST: c_int = 0x2600;
const RENDERBUFFER: Enum = 0x8D41;
const RENDERER: Enum = 0x1F01;
const REPEAT: c_int = 0x2901;
const RGBA: Enum = 0x1908;
const RGBA8: Enum = 0x8058;
const STATIC_DRAW: Enum = 0x88E4;
const TEXTURE_2D: Enum = 0x0DE1;
const TEXTURE_MAG_FILTER: Enum = 0x2800;
const TEXTURE_MIN_FILTER: Enum = 0x2801;
const TEXTURE_WRAP_S: Enum = 0x2802;
const TEXTURE_WRAP_T: Enum = 0x2803;
const TRIANGLES: Enum = 0x0004;
const UNSIGNED_BYTE: Enum = 0x1401;
const UNSIGNED_INT: Enum = 0x1405;
const VERTEX_SHADER: Enum = 0x8B31;

/// Declares the functions of OpenGL that are used, as fields, and finds them by their names.
macro_rules! functions {
    ($($field:ident = $name:literal ($($argument:ty),*) $(-> $result:ty)?;)*) => {
        #[derive(Clone, Copy)]
        struct Functions {
            $($field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Functions {
            /// # Safety
            /// `address` gives the function of OpenGL of that name, or null.
            unsafe fn find(address: impl Fn(&CStr) -> *const c_void) -> Result<Self, String> {
                $(
                    let $field = address($name);
                    if $field.is_null() {
                        return Err(format!("libOSMesa has no {}", $name.to_string_lossy()));
                    }
                )*
                // SAFETY: pointers that are not null, to functions with these signatures: those of the OpenGL registry.
                Ok(unsafe { Self { $($field: transmute_copy(&$field),)* } })
            }
        }
    };
}

functions! {
    attach_shader = c"glAttachShader"(c_uint, c_uint);
    bind_buffer = c"glBindBuffer"(Enum, c_uint);
    bind_framebuffer = c"glBindFramebuffer"(Enum, c_uint);
    bind_renderbuffer = c"glBindRenderbuffer"(Enum, c_uint);
    bind_texture = c"glBindTexture"(Enum, c_uint);
    bind_vertex_array = c"glBindVertexArray"(c_uint);
    buffer_data = c"glBufferData"(Enum, isize, *const c_void, Enum);
    check_framebuffer_status = c"glCheckFramebufferStatus"(Enum) -> Enum;
    clear = c"glClear"(c_uint);
    clear_color = c"glClearColor"(f32, f32, f32, f32);
    compile_shader = c"glCompileShader"(c_uint);
    create_program = c"glCreateProgram"() -> c_uint;
    create_shader = c"glCreateShader"(Enum) -> c_uint;
    cull_face = c"glCullFace"(Enum);
    depth_func = c"glDepthFunc"(Enum);
    draw_elements = c"glDrawElements"(Enum, c_int, Enum, *const c_void);
    enable = c"glEnable"(Enum);
    enable_vertex_attrib_array = c"glEnableVertexAttribArray"(c_uint);
    finish = c"glFinish"();
    framebuffer_renderbuffer = c"glFramebufferRenderbuffer"(Enum, Enum, Enum, c_uint);
    gen_buffers = c"glGenBuffers"(c_int, *mut c_uint);
    gen_framebuffers = c"glGenFramebuffers"(c_int, *mut c_uint);
    gen_renderbuffers = c"glGenRenderbuffers"(c_int, *mut c_uint);
    gen_textures = c"glGenTextures"(c_int, *mut c_uint);
    gen_vertex_arrays = c"glGenVertexArrays"(c_int, *mut c_uint);
    get_error = c"glGetError"() -> Enum;
    get_program_iv = c"glGetProgramiv"(c_uint, Enum, *mut c_int);
    get_shader_info_log = c"glGetShaderInfoLog"(c_uint, c_int, *mut c_int, *mut c_char);
    get_shader_iv = c"glGetShaderiv"(c_uint, Enum, *mut c_int);
    get_string = c"glGetString"(Enum) -> *const c_char;
    get_uniform_location = c"glGetUniformLocation"(c_uint, *const c_char) -> c_int;
    link_program = c"glLinkProgram"(c_uint);
    read_pixels = c"glReadPixels"(c_int, c_int, c_int, c_int, Enum, Enum, *mut c_void);
    renderbuffer_storage = c"glRenderbufferStorage"(Enum, Enum, c_int, c_int);
    shader_source = c"glShaderSource"(c_uint, c_int, *const *const c_char, *const c_int);
    tex_image_2d = c"glTexImage2D"(Enum, c_int, c_int, c_int, c_int, c_int, Enum, Enum, *const c_void);
    tex_parameter_i = c"glTexParameteri"(Enum, Enum, c_int);
    uniform_matrix_4fv = c"glUniformMatrix4fv"(c_int, c_int, u8, *const f32);
    use_program = c"glUseProgram"(c_uint);
    vertex_attrib_pointer = c"glVertexAttribPointer"(c_uint, c_int, Enum, u8, c_int, *const c_void);
    viewport = c"glViewport"(c_int, c_int, c_int, c_int);
}

/// The library with a context that is current, until the program ends.
struct OpenGl {
    gl: Functions,
}

impl OpenGl {
    fn load() -> Result<Self, String> {
        // SAFETY: the initialization of this library has no conditions.
        let library =
            LIBRARIES.iter().find_map(|name| unsafe { Library::new(*name) }.ok()).ok_or(HOW_TO_GET)?;
        // Its threads run until the program ends: it must stay.
        let library: &'static Library = Box::leak(Box::new(library));
        let text = |error: libloading::Error| error.to_string();
        // SAFETY: the signatures are those of `GL/osmesa.h`.
        let (create, make_current, get_proc_address) = unsafe {
            (
                *library
                    .get::<unsafe extern "C" fn(*const c_int, Context) -> Context>(
                        c"OSMesaCreateContextAttribs",
                    )
                    .map_err(text)?,
                *library
                    .get::<unsafe extern "C" fn(Context, *mut c_void, Enum, c_int, c_int) -> u8>(
                        c"OSMesaMakeCurrent",
                    )
                    .map_err(text)?,
                *library
                    .get::<unsafe extern "C" fn(*const c_char) -> *const c_void>(c"OSMesaGetProcAddress")
                    .map_err(text)?,
            )
        };
        // The context must have a framebuffer of its own; nothing is drawn there.
        let pixel = Box::leak(Box::new(0_u32));
        // SAFETY: the list ends with 0; the buffer has room for one pixel of four bytes, and it stays.
        let is_current = unsafe {
            let context = create(CONTEXT.as_ptr(), null_mut());
            !context.is_null() && make_current(context, (&raw mut *pixel).cast(), UNSIGNED_BYTE, 1, 1) == 1
        };
        if !is_current {
            return Err("libOSMesa gives no context of OpenGL 3.3".to_owned());
        }
        // SAFETY: a context is current; the names end with 0.
        let gl = unsafe { Functions::find(|name| get_proc_address(name.as_ptr()))? };
        Ok(Self { gl })
    }

    /// Who draws, as the library says.
    fn renderer(&self) -> String {
        // SAFETY: a context is current, so the string is there, and it stays.
        let name = unsafe { (self.gl.get_string)(RENDERER) };
        if name.is_null() {
            return String::new();
        }
        // SAFETY: it is a C string.
        unsafe { CStr::from_ptr(name) }.to_string_lossy().into_owned()
    }

    /// The name of a new object: a buffer, a texture.
    fn generate(generate: unsafe extern "C" fn(c_int, *mut c_uint)) -> c_uint {
        let mut name = 0;
        // SAFETY: there is room for one name.
        unsafe { generate(1, &raw mut name) };
        name
    }

    /// Makes the framebuffer to be drawn into: color, and depths of 24 bits.
    fn make_framebuffer(&self, [width, height]: [c_int; 2]) -> Result<(), String> {
        let gl = &self.gl;
        // SAFETY: a context is current; no pointers.
        let status = unsafe {
            (gl.bind_framebuffer)(FRAMEBUFFER, Self::generate(gl.gen_framebuffers));
            for (attachment, format) in [(COLOR_ATTACHMENT0, RGBA8), (DEPTH_ATTACHMENT, DEPTH_COMPONENT24)] {
                let buffer = Self::generate(gl.gen_renderbuffers);
                (gl.bind_renderbuffer)(RENDERBUFFER, buffer);
                (gl.renderbuffer_storage)(RENDERBUFFER, format, width, height);
                (gl.framebuffer_renderbuffer)(FRAMEBUFFER, attachment, RENDERBUFFER, buffer);
            }
            (gl.viewport)(0, 0, width, height);
            (gl.check_framebuffer_status)(FRAMEBUFFER)
        };
        if status == FRAMEBUFFER_COMPLETE { Ok(()) } else { Err(format!("framebuffer status {status:#x}")) }
    }

    /// Hands over the scene's vertices and indices.
    fn make_mesh(&self, scene: &Scene) {
        const FIELDS: [(c_uint, c_int, usize); 3] = [(0, 3, 0), (1, 3, 12), (2, 2, 24)];
        let gl = &self.gl;
        // SAFETY: a context is current; the pointers are to as many bytes as said, which are copied. Vertices are
        // `repr(C)`, and the offsets are those of their fields.
        unsafe {
            (gl.bind_vertex_array)(Self::generate(gl.gen_vertex_arrays));
            (gl.bind_buffer)(ARRAY_BUFFER, Self::generate(gl.gen_buffers));
            let (vertices, indices) = (&scene.vertices[..], &scene.indices[..]);
            let size = size_of_val(vertices) as isize;
            (gl.buffer_data)(ARRAY_BUFFER, size, vertices.as_ptr().cast(), STATIC_DRAW);
            (gl.bind_buffer)(ELEMENT_ARRAY_BUFFER, Self::generate(gl.gen_buffers));
            let size = size_of_val(indices) as isize;
            (gl.buffer_data)(ELEMENT_ARRAY_BUFFER, size, indices.as_ptr().cast(), STATIC_DRAW);
            for (place, count, offset) in FIELDS {
                let stride = size_of::<Vertex>() as c_int;
                (gl.enable_vertex_attrib_array)(place);
                (gl.vertex_attrib_pointer)(
                    place,
                    count,
                    FLOAT,
                    0,
                    stride,
                    null::<u8>().wrapping_add(offset).cast(),
                );
            }
        }
    }

    /// Hands over the texture: the nearest texel, repeated.
    fn make_texture(&self) {
        let gl = &self.gl;
        let texels: Vec<[u8; 4]> = texels().into_iter().map(|[r, g, b]| [r, g, b, 255]).collect();
        let side = TEXTURE_SIDE as c_int;
        // SAFETY: a context is current; the pointer is to side · side texels of four bytes, which are copied.
        unsafe {
            (gl.bind_texture)(TEXTURE_2D, Self::generate(gl.gen_textures));
            let texels = texels.as_ptr().cast();
            (gl.tex_image_2d)(TEXTURE_2D, 0, RGBA8 as c_int, side, side, 0, RGBA, UNSIGNED_BYTE, texels);
            for filter in [TEXTURE_MIN_FILTER, TEXTURE_MAG_FILTER] {
                (gl.tex_parameter_i)(TEXTURE_2D, filter, NEAREST);
            }
            for direction in [TEXTURE_WRAP_S, TEXTURE_WRAP_T] {
                (gl.tex_parameter_i)(TEXTURE_2D, direction, REPEAT);
            }
        }
    }

    fn compile(&self, kind: Enum, source: &str) -> Result<c_uint, String> {
        let gl = &self.gl;
        let source = CString::new(source).map_err(|error| error.to_string())?;
        let (mut status, mut log) = (0, vec![0_u8; 1024]);
        // SAFETY: a context is current; the source ends with 0, and the log has as much room as said.
        let shader = unsafe {
            let shader = (gl.create_shader)(kind);
            (gl.shader_source)(shader, 1, &source.as_ptr(), null());
            (gl.compile_shader)(shader);
            (gl.get_shader_iv)(shader, COMPILE_STATUS, &raw mut status);
            (gl.get_shader_info_log)(shader, log.len() as c_int, null_mut(), log.as_mut_ptr().cast());
            shader
        };
        if status == 1 { Ok(shader) } else { Err(String::from_utf8_lossy(&log).into_owned()) }
    }

    /// Compiles the shaders and hands over their uniforms.
    fn make_program(&self, scene: &Scene) -> Result<(), String> {
        let gl = &self.gl;
        let shaders = [
            self.compile(VERTEX_SHADER, VERTEX)?,
            self.compile(FRAGMENT_SHADER, &fragment_source(scene.is_lit))?,
        ];
        let mut status = 0;
        // SAFETY: a context is current; the pointers are to what is said, sixteen numbers of a matrix among it.
        unsafe {
            let program = (gl.create_program)();
            shaders.into_iter().for_each(|shader| (gl.attach_shader)(program, shader));
            (gl.link_program)(program);
            (gl.get_program_iv)(program, LINK_STATUS, &raw mut status);
            (gl.use_program)(program);
            let place = (gl.get_uniform_location)(program, c"clip_from_view".as_ptr());
            // The rows stand one after the other; OpenGL wants columns, so it is to transpose them.
            (gl.uniform_matrix_4fv)(place, 1, 1, scene.clip_from_view.as_flattened().as_ptr());
        }
        if status == 1 { Ok(()) } else { Err("the shaders cannot be linked".to_owned()) }
    }
}

const VERTEX: &str = "#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
uniform mat4 clip_from_view;
out vec3 surface_normal;
out vec2 surface_uv;
void main() {
    gl_Position = clip_from_view * vec4(position, 1.0);
    surface_normal = normal;
    surface_uv = uv;
}
";

fn fragment_source(is_lit: bool) -> String {
    let [x, y, z] = TO_LIGHT;
    let light = format!("min(max(dot(surface_normal, vec3({x:?}, {y:?}, {z:?})), 0.0) + {AMBIENT:?}, 1.0)");
    let brightness = if is_lit { &light } else { "1.0" };
    format!(
        "#version 330 core
in vec3 surface_normal;
in vec2 surface_uv;
uniform sampler2D picture;
out vec4 color;
void main() {{
    color = vec4(texture(picture, surface_uv).rgb * {brightness}, 1.0);
}}
"
    )
}

/// Whether the pixels are brought into memory of our own after each frame.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ReadBack {
    No,
    Yes,
}

struct Prepared {
    opengl: OpenGl,
    size: [c_int; 2],
    index_count: c_int,
    read_back: ReadBack,
    /// Pixels: blue, green, red, opacity.
    pixels: Vec<[u8; 4]>,
}

/// Makes a scene ready; a frame is done when the library says that it is.
pub(crate) fn prepare(scene: Scene) -> Result<Box<dyn Frame>, String> {
    Ok(Box::new(Prepared::new(&scene, ReadBack::No)?))
}

/// The same; a frame is done when its pixels are in memory of our own.
pub(crate) fn prepare_read_back(scene: Scene) -> Result<Box<dyn Frame>, String> {
    Ok(Box::new(Prepared::new(&scene, ReadBack::Yes)?))
}

impl Prepared {
    fn new(scene: &Scene, read_back: ReadBack) -> Result<Self, String> {
        let size = scene.size.map(|side| side as c_int);
        let opengl = OpenGl::load()?;
        let renderer = opengl.renderer();
        if !renderer.contains("llvmpipe") {
            return Err(format!("libOSMesa draws with {renderer}, not with llvmpipe"));
        }
        opengl.make_framebuffer(size)?;
        opengl.make_mesh(scene);
        opengl.make_texture();
        opengl.make_program(scene)?;
        let gl = &opengl.gl;
        // SAFETY: a context is current; no pointers.
        let error = unsafe {
            (gl.enable)(CULL_FACE);
            (gl.cull_face)(BACK);
            (gl.enable)(DEPTH_TEST);
            (gl.depth_func)(LEQUAL);
            (gl.clear_color)(0.0, 0.0, 0.0, 1.0);
            (gl.get_error)()
        };
        if error != 0 {
            return Err(format!("OpenGL error {error:#x}"));
        }
        let pixels = vec![[0; 4]; scene.size.map(|side| side as usize).iter().product()];
        Ok(Self { opengl, size, index_count: scene.indices.len() as c_int, read_back, pixels })
    }

    fn read(&mut self) {
        let [width, height] = self.size;
        // SAFETY: a context is current; there is room for all pixels.
        unsafe {
            let pixels = self.pixels.as_mut_ptr().cast();
            (self.opengl.gl.read_pixels)(0, 0, width, height, BGRA, UNSIGNED_BYTE, pixels);
        }
    }
}

impl Frame for Prepared {
    fn draw(&mut self) {
        let gl = &self.opengl.gl;
        // SAFETY: a context is current; so many indices were handed over, each of a vertex that was.
        unsafe {
            (gl.clear)(COLOR_BUFFER_BIT | DEPTH_BUFFER_BIT);
            (gl.draw_elements)(TRIANGLES, self.index_count, UNSIGNED_INT, null());
            (gl.finish)();
        }
        if self.read_back == ReadBack::Yes {
            self.read();
        }
    }

    fn picture(&mut self) -> Vec<[u8; 3]> {
        self.read();
        self.pixels.iter().map(|&[b, g, r, _]| [r, g, b]).collect()
    }
}
