// The running mirror: frame after frame from the camera to the screen, whatever happens.
#pragma once

#include "apps/global_options.h"
#include "apps/kiosk/catalogue.h"
#include "apps/kiosk/config.h"
#include "apps/kiosk/display.h"
#include "apps/kiosk/feed.h"
#include "apps/kiosk/metrics.h"
#include "apps/kiosk/painter.h"
#include "apps/kiosk/picture_scale.h"
#include "apps/kiosk/scribe.h"
#include "apps/kiosk/script.h"
#include "apps/kiosk/visitors.h"
#include "apps/kiosk/watchdog.h"
#include "apps/spoil.h"

#include <deque>
#include <memory>
#include <optional>
#include <string>

namespace toile::apps::kiosk {

struct KioskRun {
    KioskConfig config;
    std::filesystem::path config_file; ///< set-up is saved there; empty: it is not saved
    bool headless = false;
    bool realtime = false;     ///< live clock; a window always has it
    std::filesystem::path out; ///< headless: folder for every picture, or a .png for the last
    Script script;
    std::uint64_t frames = 0;     ///< 0: until the source or the user ends it
    bool draw = true;             ///< false: everything but pictures, to measure the rest
    bool stock = false;           ///< only the plugins beside the program
    bool safe = false;            ///< the same, and a plain screen
    std::uint64_t restarts = 0;   ///< by the watchdog so far
    int heartbeat = -1;           ///< file descriptor that signs of life are written to
    Spoil spoil = Spoil::none;    ///< how the camera's view is drawn wrongly, for tests
    std::filesystem::path report; ///< figures of the run, as JSON; empty: none
};

/// Not movable. Everything on one thread but what Tailor, Scribe and CatalogueWatch do on theirs.
class Kiosk {
  public:
    /// \throw Error when garments, words, plugins or the display are missing
    Kiosk(KioskRun run, const GlobalOptions& global);
    ~Kiosk();
    Kiosk(const Kiosk&) = delete;
    Kiosk& operator=(const Kiosk&) = delete;

    /// Until it is ended. \throw Error only for what cannot be gone around
    void run();

  private:
    struct Note {
        std::string words;
        double until_s = 0.0;
    };

    // kiosk.cpp: the loop
    bool frame();
    void take_frame(double dt_s);
    void give_picture(const pipeline::SensorFrame& pictures, double dt_s);
    void take_results();
    void take_changes();
    void wear_on(Shopper& shopper, DressResult result);
    void turn_to_measure(double dt_s);
    void note_fault(Fault fault, std::string words);
    void pace(double began_s) const;
    void beat(LifeSign sign = LifeSign::steady) const;
    void note_times(double began_s, double drawing_s, double ended_s);
    void look_at_clock(double wall_s, double captured_s);
    void take_faults();

    // kiosk_acts.cpp: what taps, keys, hands and scripts do
    void take_input(double dt_s);
    void take_script();
    void inject(const std::string& fault);
    void act(Action action, std::uint32_t person);
    void perform(Effect effect, Shopper* shopper);
    void join(Shopper& shopper);
    void leave(const Shopper& shopper);
    void change(Shopper& shopper, const Choice& choice);
    void wear();
    void setup_key(const render::WindowInput::Press& press);

    // kiosk_buttons.cpp: who has which buttons where
    [[nodiscard]] Arrangement arrangement() const;
    [[nodiscard]] Pointer& pointer_of(std::uint32_t person);
    void follow_reach();
    [[nodiscard]] bool on_the_left(const Shopper& shopper) const;
    [[nodiscard]] std::vector<Action> offers_of(const Shopper* shopper) const;
    [[nodiscard]] std::vector<Button> buttons() const;
    [[nodiscard]] std::vector<Hand> hands() const;
    [[nodiscard]] Caption caption_of(const Shopper& shopper, std::size_t look) const;
    [[nodiscard]] std::vector<Caption> captions() const;

    // kiosk_figures.cpp
    void write_metrics(bool now);
    void write_report();

    // kiosk_view.cpp: what is shown
    void draw();
    [[nodiscard]] std::vector<WornMeshes*> worn_meshes(bool second);
    void hide_cloth(bool second);
    void draw_picture();
    void draw_frozen();
    void rebuild_display(const std::string& why);
    void load_thumbnails();
    [[nodiscard]] ScreenView view();
    [[nodiscard]] std::optional<Vec2f> on_screen(const Vec3f& world) const;
    [[nodiscard]] render::Placement placement(const render::Rect& to) const;
    [[nodiscard]] std::string advice_line(const Shopper& shopper, std::size_t which) const;
    [[nodiscard]] std::vector<std::string> setup_lines();
    void keep_picture();
    void put_out_pictures();

    KioskRun run_;
    Texts texts_;
    std::vector<Article> articles_;
    std::unique_ptr<CatalogueWatch> watch_;
    Tailor tailor_;
    Scribe scribe_;
    Feed feed_;
    std::unique_ptr<Display> display_; ///< before visitors: their meshes are in it
    std::vector<CarouselItem> carousel_;
    Visitors visitors_;
    Screens screens_;
    std::array<Pointer, 2> pointers_; ///< of the first shopper, and of whoever else is there
    Turn turn_;
    PictureScale scale_;
    Metrics metrics_;

    pipeline::PeopleFrame people_;
    bool live_ = false;
    std::uint64_t number_ = 0;
    double now_s_ = 0.0;
    std::int64_t last_ns_ = -1;
    std::uint32_t last_sequence_ = 0;
    double last_taken_s_ = 0.0;            ///< wall, of the frame before
    std::optional<double> clock_offset_s_; ///< wall minus capture time
    Measuring measuring_ = Measuring::not_begun;
    std::uint32_t measured_ = 0; ///< whose turn it is, or was
    std::vector<LitPlace> lit_;  ///< scratch
    bool fresh_ = false;
    bool quit_ = false;
    ScreenName last_screen_ = ScreenName::invalid;
    std::deque<Note> notes_;
    Note shopper_note_;
    float azimuth_deg_ = 0.0f;
    float azimuth_goal_deg_ = 0.0f;
    double frozen_s_ = 0.0;
    std::optional<body::Pose> frozen_from_;
    std::optional<CameraSettings> floor_;
    bool snapshot_ = false;
    double hand_at_s_ = -1e9; ///< when a hand was raised last, or something was pressed
    double metrics_at_s_ = 0.0;
    std::vector<double> script_began_s_; ///< of each step that comes again, or below 0
    double script_at_s_ = 0.0;           ///< when the script was looked at last
    double clock_jump_s_ = 3600.0;       ///< of the next fault "clock"
    pipeline::StageClock clock_;
    pipeline::DurationHistogram frame_time_;
    pipeline::DurationHistogram compute_time_;  ///< all but drawing and what the picture needs
    pipeline::DurationHistogram interval_time_; ///< between garment states
    double state_at_s_ = 0.0;
    double picture_s_ = 0.0; ///< of this frame: pictures given to the renderer, light
    pipeline::DurationHistogram state_latency_;
    pipeline::DurationHistogram picture_latency_;
    pipeline::DurationHistogram draw_time_;
    double first_frame_s_ = 0.0;
    double last_frame_s_ = 0.0;
    double longest_gap_s_ = 0.0;
    std::uint64_t camera_frames_ = 0;
};

} // namespace toile::apps::kiosk
