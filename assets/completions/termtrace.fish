# Print an optspec for argparse to handle cmd's options that are independent of any subcommand.
function __fish_termtrace_global_optspecs
    string join \n eye= target= up= fov= threads= color= glyphs= cell-aspect= map= samples= quality= max-rate= fps= move-speed= turn-speed= reduced-motion= hint= order= compressed-link quiet no-config h/help V/version
end

function __fish_termtrace_needs_command
    # Figure out if the current invocation already has a command.
    set -l cmd (commandline -opc)
    set -e cmd[1]
    argparse -s (__fish_termtrace_global_optspecs) -- $cmd 2>/dev/null
    or return
    if set -q argv[1]
        # Also print the command, so this can be used to figure out what it is.
        echo $argv[1]
        return 1
    end
    return 0
end

function __fish_termtrace_using_subcommand
    set -l cmd (__fish_termtrace_needs_command)
    test -z "$cmd"
    and return 1
    contains -- $cmd[1] $argv
end

complete -c termtrace -n "__fish_termtrace_needs_command" -l eye -d 'Eye point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l target -d 'Target point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l up -d 'Up vector, vertical in the picture, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l fov -d 'Vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l threads -d 'Number of threads that trace [default: one per core]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l color -d 'Colours to draw with [default: auto]' -r -f -a "auto\t''
always\t''
never\t''
truecolor\t''
256\t''
16\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l glyphs -d 'Characters to draw with [default: auto]' -r -f -a "auto\t''
half\t''
shape\t''
ramp\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l cell-aspect -d 'A cell\'s height over its width [default: as detected, or 2]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l map -d 'The shaded picture, or a map of the scene [default: shaded]' -r -f -a "shaded\t''
lambert\t''
depth\t''
normal\t''
object\t''
shadow\t''
cost\t''
facing\t''
contrast\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l samples -d 'Rays per pixel, also in motion, or `best`: 1, and up to 64 at edges [default: as many as the time allows; best at rest]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l quality -d 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]' -r -f -a "exact\t''
equal\t''
fast\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l max-rate -d 'Average bandwidth cap in bytes per second, such as 50k or 2M [default: what the link takes]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l fps -d 'Frame-rate cap in frames per second [default: 60]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l move-speed -d 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l turn-speed -d 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l reduced-motion -d 'Each key press moves one step at once; nothing moves by itself [default: false]' -r -f -a "true\t''
false\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l hint -d 'Show the keys to press in the lowest row until the first one [default: true]' -r -f -a "true\t''
false\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l order -d 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]' -r -f -a "color\t''
raster\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l compressed-link -d 'The link compresses, as ssh -C does; the same as --order raster'
complete -c termtrace -n "__fish_termtrace_needs_command" -l quiet -d 'Do not print the camera on exit'
complete -c termtrace -n "__fish_termtrace_needs_command" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_needs_command" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_needs_command" -s V -l version -d 'Print version'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "scenes" -d 'List the built-in scenes'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "frame" -d 'Print one frame, or compare it with a golden frame'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "record" -d 'Record a film along a camera path: asciicast, GIF or numbered PNGs'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "explain" -d 'Explain one pixel: its ray, what it hit, each light'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "check" -d 'Report every fault of a scene file'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "describe" -d 'Describe a picture in words'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "bench" -d 'Measure how fast a scene is traced'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "doctor" -d 'Show what was detected about this terminal, and a test card'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "config" -d 'Show the effective settings and where each comes from'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "completions" -d 'Print shell completions'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "man" -d 'Print the man page'
complete -c termtrace -n "__fish_termtrace_using_subcommand scenes" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand scenes" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l eye -d 'Eye point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l target -d 'Target point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l up -d 'Up vector, vertical in the picture, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l fov -d 'Vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l threads -d 'Number of threads that trace [default: one per core]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l size -d 'The frame\'s size in cells [default: 80x24; PNG: 1280x800 pixels, GIF: 480x300]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l pixels -d 'The frame\'s size in pixels; a cell has two pixels, one above the other, or with --glyphs shape two by four' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l cell-aspect -d 'A cell\'s height over its width' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l samples -d 'Rays per pixel, the first through its centre; or `best`: 1, and up to 64 at edges [default: 1; PNG and GIF: best]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l scale -d 'Picture files: draw each pixel as N by N pixels of the file [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l map -d 'The shaded picture, or a map of the scene [default: shaded]' -r -f -a "shaded\t''
lambert\t''
depth\t''
normal\t''
object\t''
shadow\t''
cost\t''
facing\t''
contrast\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l color -d 'Colours to draw with [default: auto]' -r -f -a "auto\t''
always\t''
never\t''
truecolor\t''
256\t''
16\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l glyphs -d 'Characters to draw with [default: auto]' -r -f -a "auto\t''
half\t''
shape\t''
ramp\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l format -d 'Format to write [default: by the file name\'s extension, or text]' -r -f -a "text\t'Characters without colour'
ansi\t'Cells in colour'
svg\t'Cells as a drawing, one rectangle per half cell'
html\t'Cells as a web page'
png\t'A picture file'"
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -s o -l output -d 'Write to a file; - is standard output [default: -]' -r -F
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l check -d 'Compare with the frame in a file instead of writing one; exit code 1 and a diff if they differ' -r -F
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l bless -d 'With --check: write the golden frame instead of comparing'
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l eye -d 'Eye point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l target -d 'Target point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l up -d 'Up vector, vertical in the picture, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l fov -d 'Vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l threads -d 'Number of threads that trace [default: one per core]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l path -d 'Path of the camera: orbit, or a file of keyframes' -r -F
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l seconds -d 'Length of the film in seconds [default: 8, or the length of the path file]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l fps -d 'Frames per second [default: 30; GIF: 25]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l size -d 'The frame\'s size in cells [default: 80x24; PNG: 1280x800 pixels, GIF: 480x300]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l pixels -d 'The frame\'s size in pixels; a cell has two pixels, one above the other, or with --glyphs shape two by four' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l cell-aspect -d 'A cell\'s height over its width' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l samples -d 'Rays per pixel, the first through its centre; or `best`: 1, and up to 64 at edges [default: 1; PNG and GIF: best]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l scale -d 'Picture files: draw each pixel as N by N pixels of the file [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l map -d 'The shaded picture, or a map of the scene [default: shaded]' -r -f -a "shaded\t''
lambert\t''
depth\t''
normal\t''
object\t''
shadow\t''
cost\t''
facing\t''
contrast\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l order -d 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]' -r -f -a "color\t''
raster\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l quality -d 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]' -r -f -a "exact\t''
equal\t''
fast\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l max-rate -d 'Average bandwidth cap in bytes per second, such as 50k or 2M [default: what the link takes]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -s o -l output -d 'Write to FILE.cast (asciicast), FILE.gif, or FILE-%04d.png, numbered from 1; - writes an asciicast to standard output [default: -]' -r -F
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l compressed-link -d 'The link compresses, as ssh -C does; the same as --order raster'
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l eye -d 'Eye point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l target -d 'Target point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l up -d 'Up vector, vertical in the picture, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l fov -d 'Vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l threads -d 'Number of threads that trace [default: one per core]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l pixel -d 'The pixel\'s column and row, from (0, 0) at the top left' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l size -d 'The frame\'s size in cells [default: 80x24; PNG: 1280x800 pixels, GIF: 480x300]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l pixels -d 'The frame\'s size in pixels; a cell has two pixels, one above the other, or with --glyphs shape two by four' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l cell-aspect -d 'A cell\'s height over its width' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l eye -d 'Eye point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l target -d 'Target point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l up -d 'Up vector, vertical in the picture, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l fov -d 'Vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l threads -d 'Number of threads that trace [default: one per core]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l eye -d 'Eye point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l target -d 'Target point, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l up -d 'Up vector, vertical in the picture, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l fov -d 'Vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l threads -d 'Number of threads that trace [default: one per core]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l size -d 'The size of the screen, in cells' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l scene -d 'A generated scene instead of a file' -r -f -a "three\t'Three spheres on a plane'
s1k\t'1,000 spheres in a cube'
s100k\t'100,000 smaller spheres in the same cube'"
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l pixels -d 'The picture\'s size in pixels' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l samples -d 'Rays per pixel' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l threads -d 'Number of threads that trace [default: one per core]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l kernel -d 'How rays are traced through the scene; affects the time only' -r -f -a "auto\t'As packets, while that is cheaper than single rays'
single\t'Single rays, each against eight boxes or primitives at once'
packet\t'Always as packets'
scalar\t'Single rays, without SIMD instructions'"
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l rounds -d 'Number of rounds' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l no-shadow -d 'Trace no shadow rays'
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c termtrace -n "__fish_termtrace_using_subcommand doctor" -l color -d 'Colours to draw with [default: auto]' -r -f -a "auto\t''
always\t''
never\t''
truecolor\t''
256\t''
16\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand doctor" -l glyphs -d 'Characters to draw with [default: auto]' -r -f -a "auto\t''
half\t''
shape\t''
ramp\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand doctor" -l cell-aspect -d 'A cell\'s height over its width [default: as detected, or 2]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand doctor" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand doctor" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l color -d 'Colours to draw with [default: auto]' -r -f -a "auto\t''
always\t''
never\t''
truecolor\t''
256\t''
16\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l glyphs -d 'Characters to draw with [default: auto]' -r -f -a "auto\t''
half\t''
shape\t''
ramp\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l cell-aspect -d 'A cell\'s height over its width [default: as detected, or 2]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l map -d 'The shaded picture, or a map of the scene [default: shaded]' -r -f -a "shaded\t''
lambert\t''
depth\t''
normal\t''
object\t''
shadow\t''
cost\t''
facing\t''
contrast\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l samples -d 'Rays per pixel, also in motion, or `best`: 1, and up to 64 at edges [default: as many as the time allows; best at rest]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l quality -d 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]' -r -f -a "exact\t''
equal\t''
fast\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l max-rate -d 'Average bandwidth cap in bytes per second, such as 50k or 2M [default: what the link takes]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l fps -d 'Frame-rate cap in frames per second [default: 60]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l move-speed -d 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l turn-speed -d 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l reduced-motion -d 'Each key press moves one step at once; nothing moves by itself [default: false]' -r -f -a "true\t''
false\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l hint -d 'Show the keys to press in the lowest row until the first one [default: true]' -r -f -a "true\t''
false\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l keys -d 'Print the keys instead, in the form of keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand completions" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand completions" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand man" -l no-config -d 'Ignore config.ron and keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand man" -s h -l help -d 'Print help'
