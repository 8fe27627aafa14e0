"""The fixed words of the IMU's result sheet, Chinese and English side by side.

Symbols are the textbook's (2-27), (2-28); names the standard's where it has one (标度因数, 零偏, 失准角).
"""

from __future__ import annotations

from ahrs_lab.certificates.documents import Words

TITLE = Words("惯性测量组合校准证书", "IMU CALIBRATION CERTIFICATE")
METHOD = Words(
    "惯性测量组合分立标定：整周转动速率标定，{count} 位置静态标定",
    "Discrete calibration of an inertial measurement unit: rates by whole turns, {count} positions at rest",
)
RESULTS = Words("校准结果", "Results of the calibration")
GYROS = Words("陀螺", "Gyros")
ACCELEROMETERS = Words("加速度计", "Accelerometers")
CHANNEL = Words("输出通道", "Output channel")
GYRO_SCALE = Words("标度因数 E_{1}", "Scale factor E_{1}")
GYRO_BIAS = Words("零偏（常值漂移）B_{0}", "Zero offset (constant drift) B_{0}")
GYRO_FORCE = Words(
    "视加速度影响系数 B_{f}：行为输出通道，列为比力输入轴",
    "Specific-force coefficients B_{f}: rows output channels, columns axes of the specific force",
)
GYRO_MISALIGNMENT = Words(
    "失准角 E：行为输出通道，列为角速率输入轴",
    "Misalignment E: rows output channels, columns axes of the rate",
)
ACCEL_SCALE = Words("标度因数 K_{1}", "Scale factor K_{1}")
ACCEL_BIAS = Words("零偏 K_{0}", "Zero offset K_{0}")
ACCEL_MISALIGNMENT = Words(
    "失准角 K：行为输出通道，列为比力输入轴",
    "Misalignment K: rows output channels, columns axes of the specific force",
)
EXPANDED = Words("U（k = 2）", "U (k = 2)")
MATRIX_NOTE = Words("矩阵各元素为 值 ± U（k = 2）。", "Elements of matrices: value ± U (k = 2).")

POSITIONS = Words("静态位置与拟合残差", "Positions at rest and residuals of the fit")
POSITION = Words("位置", "No.")
POINTS = Words("{axis} 指向", "{axis} points")
TURNED_ON = Words("转台角", "Turned on")
GYRO_RESIDUAL = Words("陀螺 {axis}", "Gyro {axis}")
ACCEL_RESIDUAL = Words("加速度计 {axis}", "Accel. {axis}")
CONDITION = Words("条件数", "Condition numbers")
CONDITION_VALUE = Words(
    "位置矩阵 [1, f/g]：{positions}；转动矩阵：{turns}",
    "positions [1, f/g]: {positions}; turns: {turns}",
)
SCHEME = Words("位置编排", "Positions")
SCHEME_VALUE = Words("{count} 个位置，每个 {dwell} s", "{count} positions of {dwell} s each")
TURNS = Words("整周转动", "Turns")
TURNS_VALUE = Words("绕 {axes}：各 {turns} 周，{rate} °/s", "about {axes}: {turns} turns each, {rate} °/s")
REFERENCE = Words("基准", "References")
REFERENCE_VALUE = Words(
    "当地重力（{gravity} m/s²）、地球自转角速率、转台转过的整周角",
    "local gravity ({gravity} m/s²), the Earth's rate, the angle of whole turns of the table",
)
REFERENCE_PLAIN = Words(
    "当地重力、地球自转角速率、转台转过的整周角",
    "local gravity, the Earth's rate, the angle of whole turns of the table",
)

UNCERTAINTY = Words(
    "扩展不确定度 U = k u_{c}，k = 2，正态分布下包含概率约为 95 %；结果修约到与 U 相同的末位，U "
    "取两位有效数字。系数之间的协方差见结果文件。",
    "The expanded uncertainty is U = k u_{c} with k = 2, a coverage probability of about 95 % for a "
    "normal distribution; U has two significant digits, values are rounded to the same place. The "
    "covariances of the coefficients are in the result file.",
)
WITH_BENCH = Words(
    "u_{{c}} 由本次记录中传感器的噪声与漂移，以及测量设备的误差合成。设备各项的标准不确定度（括号内为证"
    "书编号，* 为假定值，无证书支持）：{figures}。",
    "u_{{c}} combines the sensors' noise and drift in this recording with the errors of the bench. "
    "Standard uncertainties of the bench (in brackets the certificate, * assumed and not supported by "
    "one): {figures}.",
)
WITHOUT_BENCH = Words(
    "u_{c} 只含本次记录中传感器的噪声与漂移，不含测量设备的误差。",
    "u_{c} is of the sensors' noise and drift in this recording alone, not of the bench's errors.",
)
MEANING = Words(
    "结果为所述条件下记录期间的平均值，U 不包含他日的变化（零偏稳定性、通电重复性、温度）。",
    "The results are means over the recording under the conditions stated; U does not cover what they "
    "may be on another day (bias instability, turn-on repeatability, temperature).",
)
ASSUMED = Words(
    "测量结果的溯源性未得到证明：测量设备的误差为假定值，无证书支持。",
    "Traceability of the results is not shown: the errors of the bench are assumed figures, which no "
    "certificate supports.",
)
TRACED_PARTLY = Words(
    "测量结果通过上列测量标准溯源；标 * 的设备误差为假定值，由其引起的部分的溯源性未得到证明。",
    "Results are traceable through the measurement standards listed above; errors of the bench marked "
    "* are assumed, and traceability is not shown for what comes from them.",
)
TRACED = Words(
    "测量结果通过上列测量标准溯源。", "Results are traceable through the measurement standards listed above."
)
FIGURES = {
    "azimuth_arcsec": (Words("指北", "north"), "″"),
    "axis_tilt_arcsec": (Words("转轴铅垂", "table axis from the vertical"), "″"),
    "level_arcsec": (Words("安装面水平", "level of the seat"), "″"),
    "fixture_perpendicularity_arcsec": (Words("夹具垂直度", "squareness of the fixture"), "″"),
    "wobble_arcsec": (Words("转轴回转误差", "wobble of the table axis"), "″"),
    "position_arcsec": (Words("转台定位", "stops of the table"), "″"),
    "latitude_deg": (Words("纬度", "latitude"), "°"),
    "timing_relative": (Words("采样时间（相对）", "sampling time (relative)"), ""),
    "gravity_mps2": (Words("重力", "gravity"), " m/s²"),
}
"""Names of :attr:`~ahrs_lab.metrology.imu_calibration.Quality.bench_figures`, and how they are printed."""

MODEL = Words(
    "模型：陀螺 N = E_{1} · [B_{0} + B_{f} f + (I + E) ω]，加速度计 N_{A} = K_{1} · [K_{0} + (I + K) "
    "f]；· 为逐通道相乘，E、K 对角线为零，x、y、z 为壳体轴，静止时比力 f 指向天。",
    "Model: gyros N = E_{1} · [B_{0} + B_{f} f + (I + E) ω], accelerometers N_{A} = K_{1} · [K_{0} + "
    "(I + K) f]; · multiplies channel by channel, E and K have zero diagonals, x, y, z are the case's "
    "axes, and f points up at rest.",
)
INVERSE = Words(
    "补偿：先 f = (I + K)^{−1} (N_{A} / K_{1} − K_{0})，再 ω = (I + E)^{−1} (N / E_{1} − B_{0} − B_{f} "
    "f)；除法逐通道进行。",
    "To compensate: first f = (I + K)^{−1} (N_{A} / K_{1} − K_{0}), then ω = (I + E)^{−1} (N / E_{1} − "
    "B_{0} − B_{f} f), dividing channel by channel.",
)
NOT_JUDGED = Words(
    "委托方给出的限值属于 JJF 1536—2015 的参数，本次标定的系数未作符合性判定。",
    "The customer's limits are of quantities of JJF 1536-2015: no conformity is stated for these "
    "coefficients.",
)
DEVIATIONS = Words("方法说明", "Remarks on the method")

# Original record
RAW_TURNS = Words("整周转动的输出", "Outputs of the whole turns")
RAW_POSITIONS = Words("静态位置的输出平均值", "Mean outputs of the positions at rest")
TABLE_ANGLE = Words("转台转角", "Angle of the table")
OUTPUT_SUM = Words("{axis} 输出累积 Σ N_{{{index}}} Δt", "Sum of output {axis} Σ N_{{{index}}} Δt")
GYRO_MEAN = Words("N_{{{index}}}", "N_{{{index}}}")
ACCEL_MEAN = Words("N_{{A{index}}}", "N_{{A{index}}}")
OF_RECORDING = Words("u（记录）", "u (recording)")
OF_BENCH = Words("u（设备）", "u (bench)")
